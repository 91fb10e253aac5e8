"""One robot of each of W worlds: observations, actions and rewards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.batch import step_change as c
from crowdbot.core.batch.parallel import Batches
from crowdbot.core.learning.actions import action_size, bounds_of, commands_between
from crowdbot.core.learning.build import build_observer, build_reward
from crowdbot.core.learning.conventions import Conventions, conventions_of
from crowdbot.core.learning.seen import LearningContext, RobotInputs, StepChange
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array, Mask
from crowdbot.core.types.robot import robot_body
from crowdbot.core.types.task import Task
from crowdbot.rl.env_setup import EnvSetup

Vectors = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class StepResult:
    """Outcome of a step, for each world; False and 0 where no step was taken.

    Attributes:
        reward: (W,).
        arrived: (W,) True where the robot has entered its goal zone in this step or before.
        touched: (W,) True where a person touched it in this step.
        late: (W,) True where the time limit has passed and it has not arrived.
    """

    reward: Array
    arrived: Mask
    touched: Mask
    late: Mask


class Actor:
    """The robot of W worlds that a policy controls.

    Args:
        worlds: W.
        robot: its index.

    Attributes:
        context: constant data of the robot.
        low, high: bounds of observations.
        size: number of elements of an action: v, w and, if the drive moves sideways, vy.
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
        self.size, self._bounds = action_size(model.limits), bounds_of(model.limits)
        self._goals, self._before = np.zeros((worlds, 2)), np.zeros((worlds, 3))
        self._distance, self._limits = np.zeros(worlds), np.zeros(worlds, np.int64)

    @property
    def conventions(self) -> Conventions:
        """Return the conventions of policies for this robot."""
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
        return commands_between(np.ascontiguousarray(actions, np.float64), *self._bounds)

    def result(self, batches: Batches, rows: Array, given: Array, here: Mask) -> StepResult:
        """Return the outcome of a step.

        Args:
            rows: (W, R, 8) states of all robots after it, see `RobotRecord`.
            given: (W, 3) commands.
            here: (W,) True for worlds that were stepped.
        """
        found, happened = c.changes(self._worlds)
        c.write_changes(
            batches.drives, rows, self._robot, self._goals, self._distance, here,
            batches.ticks, self._limits, self.context.step / TICK, found, happened,
        )  # fmt: skip
        arrived, touched, late = happened
        change = StepChange(
            progress=found[c.PROGRESS],
            distance=found[c.DISTANCE],
            arrived=arrived,
            contact=found[c.CONTACT],
            wall=found[c.WALL],
            gap=found[c.GAP],
            advance=found[c.ADVANCE],
            work=found[c.WORK],
            forced=found[c.FORCED],
            aside=found[c.ASIDE],
            command=given,
            before=self._before.copy(),
        )
        reward = np.where(here, self._reward.of(change), 0.0)
        c.keep_commands(given, here, self._before)
        return StepResult(reward, arrived, touched, late)

    def look(
        self, batches: Batches, rows: Array, fresh: Mask, stepped: Mask, people: Array
    ) -> Vectors:
        """Return observations (W, N).

        Args:
            rows: (W, R, 8) states of all robots, see `RobotRecord`.
            fresh, stepped: (W,) as in `RobotInputs`.
            people: (W, M, 5) as in `RobotInputs`.
        """
        pose, twist = np.empty((2, self._worlds, 3))
        c.write_motion(rows, self._robot, pose, twist)
        return self._observer.observe(
            RobotInputs(
                fresh=fresh,
                stepped=stepped,
                pose=pose,
                twist=twist,
                goal=self._goals,
                readings=self.readings(batches),
                people=people,
            )
        )

    def readings(self, batches: Batches) -> dict[str, Array]:
        """Return the latest readings (W, ...) of its sensors, by name."""
        return {seen.name: self._ranges(batches, k, seen) for k, seen in self._sensors}

    def _ranges(self, batches: Batches, k: int, seen: Any) -> Array:
        shape = seen.info.shape
        out = np.empty((self._worlds, *((1, *shape) if len(shape) == 1 else shape)))
        batches.ranges(k, out)
        return out[:, 0] if len(shape) == 1 else out
