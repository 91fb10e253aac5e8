"""One robot of each of W worlds: what it observes, how its actions are meant, what it earns."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.batch.parallel import Batches
from crowdbot.core.batch.robot_tables import DRIVE_STATE
from crowdbot.core.crowd.contact.robot_contact import R_W, R_YAW, RVX, RVY
from crowdbot.core.learning.actions import action_size, commands_of
from crowdbot.core.learning.build import build_observer, build_reward
from crowdbot.core.learning.conventions import Conventions, conventions_of
from crowdbot.core.learning.seen import LearningContext, RobotInputs, StepChange
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.core.types.robot import robot_body
from crowdbot.core.types.task import Task
from crowdbot.rl.env_setup import EnvSetup

Vectors = NDArray[np.float32]
_DRIVE = {name: column for column, name in enumerate(DRIVE_STATE.names)}


class Actor:
    """A robot of W worlds.

    Args:
        worlds: W.
        robot: its index.

    Attributes:
        context: constant data of the robot.
        low, high: bounds of observations.
        size: how many numbers an action has: v, w and, where the drive can, vy.
    """

    def __init__(self, setup: EnvSetup, worlds: int, robot: int) -> None:
        first = next(iter(setup.blueprints.values()))
        model, self._robot, self._worlds = first.models[robot], robot, worlds
        self._spec = setup.observation
        self._sensors = [(k, s) for k, s in enumerate(first.sensors) if s.robot == robot]
        self.context = LearningContext(
            worlds=worlds,
            limits=model.limits,
            body=robot_body(model),
            sensors={seen.name: seen.info for _, seen in self._sensors},
            step=first.period * TICK,
        )
        self._observer = build_observer(setup.registry, setup.observation, self.context)
        self._reward = build_reward(setup.registry, setup.reward, self.context)
        self.low, self.high = self._observer.low, self._observer.high
        self.size = action_size(model.limits)
        self._goals, self._before = np.zeros((worlds, 2)), np.zeros((worlds, 3))
        self._distance, self._limits = np.zeros(worlds), np.zeros(worlds, np.int64)

    @property
    def conventions(self) -> Conventions:
        """Return the conventions of policies that act as this robot."""
        return conventions_of(self._spec, self._observer, self.context)

    def begin(self, w: int, tasks: Sequence[Task]) -> None:
        """Begin an episode in one world."""
        task = tasks[self._robot]
        self._goals[w] = task.goal
        self._limits[w] = round(task.time_limit / TICK)
        self._distance[w] = np.hypot(*(np.array(task.goal) - task.start[:2]))
        self._before[w] = 0.0

    def commands(self, actions: Array) -> Array:
        """Return commands v, w, vy (W, 3) of actions (W, `size`), m/s and rad/s."""
        return commands_of(actions, self.context.limits)

    def news(self, batches: Batches) -> Array:
        """Return (W, D) `DriveStateRecord` of the robot after a step, a copy."""
        return batches.drives[:, self._robot].copy()

    def reward(self, news: Array, rows: Array, given: Array, here: Mask) -> Array:
        """Return the rewards (W,) of a step; 0 where no step was taken.

        Args:
            news: as of `news`.
            rows: (W, R, 8) of all robots after it.
            given: (W, 3) commands.
            here: (W,) True for worlds that were stepped.
        """
        away = self._goals - rows[:, self._robot, :2]
        distance = np.hypot(away[:, 0], away[:, 1])
        progress, self._distance = self._distance - distance, distance
        ticks = self.context.step / TICK
        change = StepChange(
            progress=progress,
            distance=distance,
            arrived=self.arrived(news) & here,
            contact=news[:, _DRIVE["touched"]] / ticks,
            wall=news[:, _DRIVE["blocked"]] / ticks,
            gap=news[:, _DRIVE["gap"]],
            advance=news[:, _DRIVE["advance"]],
            work=news[:, _DRIVE["work"]],
            command=given,
            before=self._before,
        )
        found = np.where(here, self._reward.of(change), 0.0)
        self._before = np.where(here[:, np.newaxis], given, self._before)
        return np.asarray(found)

    def arrived(self, news: Array) -> Mask:
        """Return (W,) True where the robot has entered its goal zone in this step or before."""
        return np.asarray(news[:, _DRIVE["arrived"]] >= 0.0)

    def touched(self, news: Array) -> Mask:
        """Return (W,) True where a person touched the robot in the last step."""
        return np.asarray(news[:, _DRIVE["touched"]] > 0.0)

    def late(self, batches: Batches) -> Mask:
        """Return (W,) True where the time limit is over."""
        return np.asarray(batches.now >= self._limits)

    def look(
        self, batches: Batches, rows: Array, fresh: Mask, stepped: Mask, people: Array
    ) -> Vectors:
        """Return observations (W, N).

        Args:
            rows: (W, R, 8) of all robots.
            fresh, stepped: (W,) as of `RobotInputs`.
            people: (W, M, 5) as of `RobotInputs`.
        """
        own = rows[:, self._robot]
        cos, sin = np.cos(own[:, R_YAW]), np.sin(own[:, R_YAW])
        twist = np.empty((self._worlds, 3))
        twist[:, 0] = cos * own[:, RVX] + sin * own[:, RVY]
        twist[:, 1] = own[:, R_W]
        twist[:, 2] = cos * own[:, RVY] - sin * own[:, RVX]
        return self._observer.observe(
            RobotInputs(
                fresh=fresh,
                stepped=stepped,
                pose=own[:, [0, 1, R_YAW]],
                twist=twist,
                goal=self._goals,
                readings={seen.name: self._ranges(batches, k, seen) for k, seen in self._sensors},
                people=people,
            )
        )

    def _ranges(self, batches: Batches, k: int, seen: Any) -> Array:
        shape = seen.info.shape
        out = np.empty((self._worlds, *((1, *shape) if len(shape) == 1 else shape)))
        batches.ranges(k, out)
        return out[:, 0] if len(shape) == 1 else out
