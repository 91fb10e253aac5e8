"""Safety stop: the largest fraction of the user's command from which the robot can still stop.

After Krotkov, Simmons, Cozman, Koenig, "Safeguarded teleoperation for lunar rovers", 1996: a
command passes unless it is unsafe. With an autonomous planner, that one drives instead of the
brakes.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Command, Observation, Planner, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.safety_stop.safety_stop import SafetyStopSpec
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.stopping_build import arc_gap_moving, compile_stopping
from crowdbot.plugins.planners.shared.surroundings_build import (
    PlannerSurroundings,
    bodies_in_base,
)
from crowdbot.plugins.planners.shared.user_input_build import UserInput

#: Shares of a speed that are tried, the largest first.
_SHARES = np.linspace(1.0, 0.0, 11).tolist()
#: What is already nearer than the margin may be passed but not approached, m.
_SLACK = 1e-3


class SafetyStop:
    """Slows the user's command down, or lets another planner drive while it is unsafe."""

    _limits: RobotLimits  # from `reset` on

    def __init__(self, spec: SafetyStopSpec, half: Planner | None) -> None:
        self._spec, self._half = spec, half
        self._user, self._surroundings = UserInput(), PlannerSurroundings(spec)
        self._robot = covering_discs(spec.robot_radius, None)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store limits and outline, reset the other planner; compile kernels."""
        self._user.reset(sensors, limits)
        self._surroundings.reset(sensors)
        self._robot = covering_discs(self._spec.robot_radius, task.robot)
        self._limits = limits
        compile_stopping()
        if self._half is not None:
            self._half.reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        """Return the user's command, as far as it is safe."""
        requested = self._user.command(obs)
        bodies = bodies_in_base(self._surroundings.see(obs))
        other = None if self._half is None else self._half.step(obs)
        command = self._braked(requested, bodies)
        obs.log("safety_stop/intervenes", float(command != requested))
        if other is None or command == requested:
            return command
        return self._braked(other, bodies)

    def _braked(self, command: Command, bodies: Array) -> Command:
        """Return a command slowed until it is safe: the speed first, then the turn."""
        need = min(self._spec.margin, self._gap(Command(0.0, 0.0), bodies) - _SLACK)
        v, w, vy = command
        for share in _SHARES:
            slower = Command(share * v, w, share * vy)
            if self._gap(slower, bodies) >= need:
                return slower
        for share in _SHARES:
            turn = Command(0.0, share * w)
            if self._gap(turn, bodies) >= need:
                return turn
        return Command(0.0, 0.0)

    def _gap(self, command: Command, bodies: Array) -> float:
        """Return the least gap until the robot stands, m; sideways speed is not looked at."""
        v, w, _ = command
        return arc_gap_moving(
            bodies, self._robot, v, w, self._spec.reaction_time, self._limits.a_max
        )


def build(spec: SafetyStopSpec, half: Planner | None = None) -> SafetyStop:
    """Build a planner from its spec; ``half``: the planner that takes over, if any."""
    return SafetyStop(spec, half)
