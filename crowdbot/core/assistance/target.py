"""The person or group that a robot's task is about, found among the drawn people."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.stance import PersonCircle, together
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import from_source
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.person_task import PersonTask
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.scenario.person_goals import (
    AccompanyGoal,
    ApproachGoal,
    FollowGoal,
    LeadGoal,
    PersonGoal,
    WhichPerson,
)
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """The people that a task is about.

    Attributes:
        goal: the goal as the scenario specifies it.
        rows: (M,) rows of them in the table of people.
        id: (M,) their numbers.
        x, y, heading: (M,) at the start, m and rad.
        radius: (M,) m.
    """

    goal: PersonGoal
    rows: NDArray[np.int64]
    id: NDArray[np.int64]
    x: Array
    y: Array
    heading: Array
    radius: Array

    @property
    def at_start(self) -> PersonCircle:
        """Return the person, or the circle around the group, at t = 0 as arrays (1,)."""
        at = self.x[np.newaxis], self.y[np.newaxis], self.heading[np.newaxis]
        return together(at[0], at[1], at[2], self.radius)

    def task(self) -> PersonTask:
        """Return the part of the task that a planner gets."""
        goal = self.goal
        side = goal.side if isinstance(goal, AccompanyGoal) else "either"
        hold = goal.hold if isinstance(goal, ApproachGoal | FollowGoal | AccompanyGoal) else 0.0
        return PersonTask(
            kind=goal.kind,  # type: ignore[arg-type] # the kinds of goals are those of tasks
            distance=goal.distance,
            tolerance=goal.tolerance,
            angle=goal.angle,
            hold=hold,
            in_a_row=goal.in_a_row,
            knows=goal.knows,
            radius=float(self.at_start.radius[0]),
            side=side,
        )


def find_targets(
    scenario: Scenario, parts: EnvironmentParts, people: Realisation
) -> Mapping[str, Target]:
    """Return the target of each robot that has one, by the robot's name.

    Args:
        scenario: with its robots.
        people: drawn from it.

    Raises:
        InputError: the people of a goal are not there, or not at the start.
    """
    goals = {name: robot.task.person for name, robot in scenario.robots.items()}
    return {
        name: _target(scenario, parts, people, name, goal)
        for name, goal in goals.items()
        if goal is not None
    }


def led_people(targets: Mapping[str, Target]) -> Mapping[str, Target]:
    """Return the targets that follow their robots."""
    return {name: t for name, t in targets.items() if isinstance(t.goal, LeadGoal)}


def _target(
    scenario: Scenario, parts: EnvironmentParts, people: Realisation, robot: str, goal: PersonGoal
) -> Target:
    rows = _rows(scenario, parts, people, robot, goal.person)
    if not len(rows) or np.any(people.start_time[rows] > 0.0):
        raise InputError(
            f"{scenario.id}: the goal of robot '{robot}' is {goal.person}, and no such person is "
            "there at the start"
        )
    return Target(
        goal=goal,
        rows=rows,
        id=people.id[rows],
        x=people.x[rows],
        y=people.y[rows],
        heading=people.heading[rows],
        radius=people.radius[rows],
    )


def _rows(
    scenario: Scenario,
    parts: EnvironmentParts,
    people: Realisation,
    robot: str,
    selection: WhichPerson,
) -> NDArray[np.int64]:
    """Return rows of the people that a goal selects, drawn from the crowd's seed if need be."""
    if selection.agent is not None:
        return np.flatnonzero(people.id == selection.agent)
    if selection.group is not None:
        explicit = {a.id for a in scenario.crowd.agents} if scenario.crowd else set[int]()
        named = np.isin(people.id, sorted(explicit))
        return np.flatnonzero(named & (people.group == selection.group))
    assert scenario.crowd is not None  # checked on validation
    source = (
        f"spawn {selection.spawn}" if selection.spawn is not None else f"stream {selection.stream}"
    )
    ids = np.array(from_source(scenario, parts, source), np.int64)
    found = np.flatnonzero(np.isin(people.id, ids) & (people.start_time == 0.0))
    if not len(found):
        return found
    seed = scenario.crowd.seed
    rng = np.random.default_rng(stream_seed(seed.root, seed.key, f"task.person.{robot}"))
    drawn = found[int(rng.integers(len(found)))]
    group = int(people.group[drawn])
    alone = not selection.whole_group or group < 0
    return np.asarray(found[found == drawn] if alone else found[people.group[found] == group])


def lidars_of(sensors: Mapping[str, SensorInfo]) -> dict[str, SensorInfo]:
    """Return the planar lidars, in whose scans people are detected."""
    return {
        name: info
        for name, info in sensors.items()
        if info.category == "lidar" and info.angles is not None and info.angles.ndim == 1
    }
