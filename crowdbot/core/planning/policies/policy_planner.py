"""A planner that runs a trained policy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.learning.actions import action_size, commands_of
from crowdbot.core.learning.build import CheckedObserver, build_observer
from crowdbot.core.learning.conventions import Conventions
from crowdbot.core.learning.seen import LearningContext, RobotInputs
from crowdbot.core.planning.planner import Observation
from crowdbot.core.registry.registry import Registry
from crowdbot.core.support.immutable import immutable
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError

#: Returns the action (1, K) of an observation (1, N), without noise.
Policy = Callable[[NDArray[np.float32]], NDArray[np.float32]]
#: Body where a task says nothing of it.
_UNKNOWN = RobotBody(
    drive="differential", radius=0.3, footprint=None, front=0.3, back=0.3, half_width=0.3
)


class PolicyPlanner:
    """Computes the policy's observation, and turns its action into a command.

    Args:
        name: of its file, for messages.
    """

    def __init__(
        self, policy: Policy, conventions: Conventions, registry: Registry, name: str
    ) -> None:
        self._policy, self._conventions, self._name = policy, conventions, name
        self._registry = registry
        self._observer: CheckedObserver | None = None
        self._people: Callable[[Any], Array] | None = None

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Build the observer for this robot.

        Raises:
            PlannerError: the policy was trained for a robot with other sensors or another drive.
        """
        del seed
        own = self._conventions
        needs = own.observation.needs
        used = {n: i for n, i in sensors.items() if n in needs or i.category in needs}
        context = LearningContext(
            worlds=1, limits=limits, body=task.robot or _UNKNOWN, sensors=used, step=own.step
        )
        observer = build_observer(self._registry, own.observation, context)
        if observer.size != own.size:
            raise PlannerError(
                f"{self._name} was trained on observations of {own.size} numbers; "
                f"'{own.observation.kind}' has {observer.size} with the sensors of this robot"
            )
        if action_size(limits) != len(own.action):
            raise PlannerError(
                f"{self._name} acts by {', '.join(own.action)}, and this robot's commands have "
                f"{action_size(limits)} numbers"
            )
        observer.observe(_nothing(used, own.observation.tracks))  # compiles what is not yet
        self._observer = build_observer(self._registry, own.observation, context)
        self._limits, self._sensors = limits, tuple(used)
        self._steps = 0
        self._people = observer.tracker() if own.observation.tracks else None

    def step(self, obs: Observation) -> Command:
        """Return the command of the policy's action.

        Raises:
            PlannerError: its action is not finite.
        """
        assert self._observer is not None
        action = np.asarray(self._policy(self._observer.observe(self._seen(obs))), np.float64)
        self._steps += 1
        if not np.isfinite(action).all():
            raise PlannerError(f"{self._name} returned an action that is not finite")
        v, w, vy = commands_of(action, self._limits)[0].tolist()
        return Command(v, w, vy)

    def _seen(self, obs: Observation) -> RobotInputs:
        """Return the inputs of the policy's observer, as one world."""
        pose, people = obs.pose, np.zeros((1, 0, 5))
        if self._conventions.observation.privileged and obs.truth is not None:
            truth = obs.truth
            pose = truth.pose
            rows = [truth.people, truth.people_velocity, truth.people_radius[:, np.newaxis]]
            people = np.concatenate(rows, axis=1)[np.newaxis]
        elif self._people is not None:
            people = self._people(obs)[np.newaxis]
        readings = {
            name: obs.readings[name].values[np.newaxis]
            for name in self._sensors
            if name in obs.readings
        }
        missing = set(self._sensors) - set(readings)
        if missing:
            raise PlannerError(f"there is no reading of {', '.join(sorted(missing))} yet")
        return RobotInputs(
            fresh=np.array([self._steps == 0]),
            stepped=np.array([self._steps > 0]),
            pose=np.array([pose], np.float64),
            twist=np.array([[*obs.twist, obs.vy]], np.float64),
            goal=np.array([obs.goal], np.float64),
            readings=readings,
            people=people,
        )


def _nothing(sensors: Mapping[str, SensorInfo], tracks: bool) -> RobotInputs:
    """Return the inputs of a robot with nothing around it."""
    return RobotInputs(
        fresh=np.array([True]),
        stepped=np.array([False]),
        pose=np.zeros((1, 3)),
        twist=np.zeros((1, 3)),
        goal=np.ones((1, 2)),
        readings={n: immutable(np.full((1, *i.shape), np.inf)) for n, i in sensors.items()},
        people=np.zeros((1, int(tracks), 5)),
    )
