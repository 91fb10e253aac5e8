"""People who follow a robot: their goal is the robot's position; people's limits of motion hold."""

from __future__ import annotations

import math
from dataclasses import dataclass

from crowdbot.core.assistance.target import Target
from crowdbot.core.crowd import state as s
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.person_goals import LeadGoal


@dataclass(frozen=True, slots=True, kw_only=True)
class LedPeople:
    """The people who follow one robot.

    Attributes:
        robot: its number.
        target: these people; its goal is a `LeadGoal`.
        reach: how far the robot reaches, m.
    """

    robot: int
    target: Target
    reach: float

    def set_goals(self, crowd: Array, x: float, y: float) -> None:
        """Set the goals of the people in a crowd's state, in place.

        Each walks straight towards the robot, stops at a distance, and stands while the robot is
        too far away.

        Args:
            crowd: flat state.
            x, y: position of the robot, m.
        """
        goal = self.target.goal
        assert isinstance(goal, LeadGoal)
        _, people = s.view(crowd)
        for row, radius in zip(self.target.rows, self.target.radius.tolist(), strict=True):
            px, py = float(people[row, s.X]), float(people[row, s.Y])
            away = math.hypot(x - px, y - py)
            gap = away - radius - self.reach
            left = gap - goal.keeps if goal.keeps < gap <= goal.loses else 0.0
            share = left / away if away > 0.0 else 0.0
            people[row, s.GOAL_X] = px + share * (x - px)
            people[row, s.GOAL_Y] = py + share * (y - py)
