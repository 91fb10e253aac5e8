"""A planner that calls another planner, its half, in each step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.planning.process.process_planner import ProcessPlanner
from crowdbot.core.planning.selected_sensors import select_sensors
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task


class HalfPlanner:
    """The called planner: gets its own observation, and its commands are clamped to the limits.

    Args:
        planner: of this process or of a process of its own.
        name: its kind or class, for messages.
        needs: sensors that it reads; None: all.
        privileged: True if it may read the truth.
    """

    def __init__(
        self,
        planner: Planner,
        name: str,
        needs: Sequence[str] | None,
        *,
        origin: str = "",
        privileged: bool = False,
    ) -> None:
        self._planner, self._name, self._origin = planner, name, origin
        self._needs, self._privileged = needs, privileged
        self._host: PlannerHost | None = None
        self._visible: tuple[str, ...] = ()

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Reset the called planner, see `Planner.reset`.

        Raises:
            PlannerError: it failed.
        """
        self._visible = select_sensors(
            self._needs, sensors, self._name, privileged=self._privileged
        )
        self._host = PlannerHost(
            self._planner,
            self._name,
            limits,
            origin=self._origin,
            copies=not isinstance(self._planner, ProcessPlanner),
        )
        self._host.reset(task, {n: sensors[n] for n in self._visible}, seed)

    def step(self, obs: Observation) -> Command:
        """Return the command as `Planner.step`; zero if it has no valid command.

        Raises:
            PlannerError: it failed.
        """
        assert self._host is not None
        readings = {n: obs.readings[n] for n in self._visible if n in obs.readings}
        truth = obs.truth if self._privileged else None
        return self._host.step(replace(obs, readings=readings, truth=truth)).command

    def close(self) -> None:
        """End the called planner's process, if it has one."""
        if isinstance(self._planner, ProcessPlanner | PlannerWithHalf):
            self._planner.close()


@dataclass(frozen=True, slots=True)
class PlannerWithHalf:
    """A planner and the one that it calls, so that both can be closed."""

    planner: Planner
    half: HalfPlanner

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Like `Planner.reset`."""
        self.planner.reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        """Return the calling planner's command, see `Planner.step`."""
        return self.planner.step(obs)

    def close(self) -> None:
        """End the called planner's process, if it has one."""
        self.half.close()
