"""The planner of a robot in a live run: obeys external commands."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping

from crowdbot.core.live.robot_messages import RobotMessages
from crowdbot.core.live.scene import LiveScene
from crowdbot.core.live.steps import LiveSteps
from crowdbot.core.planning.planner import NoValidCommand, Observation
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError

#: Total time that steps wait for a driver while there is none, s; then they do not wait.
_ALONE = 30.0


class LivePlanner:
    """Drives one robot with external commands."""

    def __init__(self, steps: LiveSteps, scene: LiveScene) -> None:
        self._steps, self._scene = steps, scene
        self._session, self._policy = steps.session, steps.policy
        self._alone = 0.0
        self._last, self._heard = Command(0.0, 0.0), -math.inf

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Announce the topics of this robot, and publish its constant data."""
        del limits
        messages = RobotMessages(self._scene, task, sensors, seed, self._policy.epoch)
        self._steps.join(self._scene.name, messages)

    def step(self, obs: Observation) -> Command:
        """Publish the observation, and return the external command.

        Raises:
            NoValidCommand: there is no command.
            PlannerError: there is no command, and that ends the run.
        """
        if not self._steps.begin(self._scene.name, obs):
            return Command(0.0, 0.0)
        answer = self._answer() if self._policy.lockstep else self._newest(obs.t)
        self._steps.taken(self._scene.name)
        return self._obeyed(answer, obs.t)

    def _answer(self) -> Command | None:
        """Wait for the command of this step."""
        session, robot, steps = self._session, self._scene.namespace, self._steps
        driven = session.is_driven(robot)
        patience = self._policy.budget
        if driven:
            self._alone = 0.0
        else:
            patience = min(patience, max(_ALONE - self._alone, 0.0))
        left = steps.shown + patience - time.monotonic()
        answer = session.answer(left, steps.tell_who_came, robot)
        if not driven:
            self._alone += time.monotonic() - steps.shown
        return answer

    def _newest(self, t: float) -> Command | None:
        """Return the latest command if it is not too old."""
        command, fresh = self._session.newest(self._scene.namespace)
        if fresh:
            self._heard = t
            return command
        if t - self._heard <= self._policy.hold and command is not None:
            self._session.counts.missed += 1
            return command
        return None

    def _obeyed(self, answer: Command | None, t: float) -> Command:
        """Return the command, or the substitute for a missing one."""
        if answer is not None:
            self._last = answer
            return answer
        if self._session.must_stop:
            return Command(0.0, 0.0)
        self._session.counts.missed += 1
        if self._policy.missed == "fail":
            raise PlannerError(f"no command came for the step at {t:g} s")
        if self._policy.missed == "hold":
            return self._last
        raise NoValidCommand
