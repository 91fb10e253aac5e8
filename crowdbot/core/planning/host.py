"""Planner host: calls a planner and validates everything it returns."""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple, NoReturn, TypeVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.planning.guarded import GuardedPlanner, planner_title
from crowdbot.core.planning.planner import NoValidCommand, Observation, Planner
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.core.support.compile_cache import compiled
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import Reading, SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerHungError

T = TypeVar("T", bound=np.generic)

STOP = Command(0.0, 0.0)
#: Seconds that ``reset`` may take under a watchdog, for loading models. Compilation gets more time.
RESET_LIMIT = 120.0
#: Excess over a limit by rounding that does not count as clamping.
_ROUNDING = 1e-9


class HostedCommand(NamedTuple):
    """A command within the limits, True if it was clamped, and the planner's wall time."""

    command: Command
    clamped: bool
    seconds: float


class PlannerHost:
    """Calls a robot's planner for one run and checks what it returns.

    Args:
        planner: anything with ``reset`` and ``step``.
        name: name for messages.
        limits: box into which commands are clamped.
        budget: seconds of wall time that a step may take; None sets no limit.
        watchdog: ends a step that never returns; None: wait forever.
        origin: the planner's distribution or file, for messages.
        copies: True to pass copies of arrays; a planner in a separate process has copies anyway.

    Attributes:
        steps: steps so far.
        clamped: number of clamped commands.
        stops: number of steps without a valid command.
    """

    def __init__(
        self,
        planner: Planner,
        name: str,
        limits: RobotLimits,
        *,
        budget: float | None = None,
        watchdog: Watchdog | None = None,
        origin: str = "",
        copies: bool = True,
    ) -> None:
        self._planner, self._limits, self._copies = planner, limits, copies
        self._who = planner_title(name, origin)
        self._guarded = GuardedPlanner(planner, self._who, watchdog)
        self._budget, self._watchdog = budget, watchdog
        self.steps = self.clamped = self.stops = 0

    def reset(self, task: Task, sensors: Mapping[str, SensorInfo], seed: int) -> None:
        """Reset the planner and the counters.

        Raises:
            PlannerError: the planner raised.
            PlannerHungError: it did not return.
        """
        self.steps = self.clamped = self.stops = 0
        task = replace(task, goal_zone=_read_only(task.goal_zone))
        sensors = MappingProxyType({n: _constant(i) for n, i in sensors.items()})
        patience = self._watchdog.patience(RESET_LIMIT, compiled) if self._watchdog else None
        with patience or contextlib.nullcontext():
            try:
                self._guarded.reset(task, replace(self._limits), sensors, seed)
            except PlannerHungError:
                self._hung("reset")

    def step(self, obs: Observation) -> HostedCommand:
        """Request the next command.

        Args:
            obs: the observation; its arrays are copied if ``copies``.

        Raises:
            PlannerError: the planner raised, returned something that is not a command, or
                exceeded the budget.
            PlannerHungError: it did not return.
        """
        seen = _protected(obs) if self._copies else obs
        begin = time.perf_counter()
        try:
            requested = self._guarded.step(seen)
        except NoValidCommand:
            requested = STOP
            self.stops += 1
        except PlannerHungError:
            self._hung("step")
        seconds = time.perf_counter() - begin
        self.steps += 1
        if self._budget is not None and seconds > self._budget:
            self._guarded.fail(f"step took {seconds:.3g} s; the budget is {self._budget:g} s")
        command, clamped = self._clamp(requested)
        self.clamped += clamped
        return HostedCommand(command, clamped, seconds)

    def _hung(self, method: str) -> NoReturn:
        """Raise the error for a planner that the watchdog ended."""
        limit = self._watchdog.limit if self._watchdog else math.nan
        raise PlannerHungError(
            f"{self._who} did not return from {method} within {limit:g} s"
        ) from None

    def _clamp(self, command: Command) -> tuple[Command, bool]:
        """Clamp a command into the limits; vy becomes 0 for a robot without sideways drive."""
        limits, (v, w, vy) = self._limits, command
        inside = Command(
            min(max(v, limits.v_min), limits.v_max),
            min(max(w, -limits.w_max), limits.w_max),
            min(max(vy, -limits.vy_max), limits.vy_max),
        )
        if inside == command:
            return inside, False
        excess = max(abs(v - inside.v), abs(w - inside.w), abs(vy - inside.vy))
        return inside, excess > _ROUNDING


def _read_only(array: NDArray[T]) -> NDArray[T]:
    copy = np.array(array)
    copy.setflags(write=False)
    return copy


def _constant(info: SensorInfo) -> SensorInfo:
    return info if info.angles is None else replace(info, angles=_read_only(info.angles))


def _private(reading: Reading) -> Reading:
    colour = None if reading.colour is None else _read_only(reading.colour)
    return Reading(reading.stamp, _read_only(reading.values), colour)


def _protected(obs: Observation) -> Observation:
    """Return copies, since the simulation may change arrays that a planner keeps."""
    readings = {n: _private(r) for n, r in obs.readings.items()}
    return replace(
        obs,
        goal_zone=_read_only(obs.goal_zone),
        readings=MappingProxyType(readings),
        truth=obs.truth and obs.truth.copy(),
    )
