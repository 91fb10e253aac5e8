"""A guarded planner, whose exceptions and return values are checked.

Used by the host for planners in the simulator's process, and by separate planner processes, so
messages are the same.
"""

from __future__ import annotations

import contextlib
import inspect
import math
from collections.abc import Mapping
from contextlib import AbstractContextManager
from numbers import Real
from typing import Any

from crowdbot.core.planning.planner import NoValidCommand, Observation, Planner
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.plugin_errors import is_user_interrupt
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError

_SHOWN = 80


def planner_title(name: str, origin: str) -> str:
    """Return the name of a planner for messages."""
    return f"planner '{name}'" + (f" ({origin})" if origin else "")


class GuardedPlanner:
    """Calls a planner and returns its command, or raises `NoValidCommand` or a `PlannerError`.

    Args:
        planner: anything with ``reset`` and ``step``.
        who: start of every message.
        around: context manager around each call, such as a watchdog.
    """

    def __init__(
        self,
        planner: Planner,
        title: str,
        around: AbstractContextManager[Any] | None = None,
    ) -> None:
        self._planner = planner
        self._around = around or contextlib.nullcontext()
        self._reset_call = PluginCall(
            title, sources=self._sources, error=PlannerError, passes=PlannerError
        )
        self._step_call = PluginCall(
            title,
            sources=self._sources,
            error=PlannerError,
            passes=(PlannerError, NoValidCommand),
        )

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Reset the planner, see `Planner.reset`.

        Raises:
            PlannerError: the planner raised.
        """
        with self._around, self._reset_call("reset"):
            self._planner.reset(task, limits, sensors, seed)

    def step(self, obs: Observation) -> Command:
        """Return the planner's command of finite floats, see `Planner.step`.

        Raises:
            PlannerError: the planner raised, or returned something that is not a command.
            NoValidCommand: it has no valid command.
        """
        with self._around, self._step_call("step"):
            return self._checked(self._planner.step(obs))

    def fail(self, problem: str) -> None:
        """Report an error in a step.

        Raises:
            PlannerError: always.
        """
        self._step_call.fail(problem)

    def _sources(self) -> frozenset[str]:
        """Return the files that define the planner's class and its bases."""
        found = set()
        for base in type(self._planner).__mro__[:-1]:
            with contextlib.suppress(TypeError, OSError):
                found.add(inspect.getfile(base))
        return frozenset(found)

    def _checked(self, answer: Any) -> Command:
        """Return the result as a command of finite floats.

        Unusual number classes may run code here.
        """
        shaped = isinstance(answer, tuple) and len(answer) in (2, 3)
        if not shaped or not all(map(_is_number, answer)):
            self.fail(
                f"step returned {_shown(answer)}; a Command(v, w) or a tuple of 2 or 3 numbers "
                "is wanted"
            )
        try:
            command = Command(*map(float, answer))
        except OverflowError:  # a whole number above 1.8e308
            command = Command(math.inf, 0.0)
        if not all(map(math.isfinite, command)):
            self.fail(f"step returned {_shown(answer)}; a command must be finite")
        return command


def _is_number(value: object) -> bool:
    # Checking for a number class takes longer than all other checks of a command.
    return type(value) is float or (isinstance(value, Real) and not isinstance(value, bool))


def _shown(value: Any) -> str:
    try:
        text = str(repr(value))
    except BaseException as error:
        if is_user_interrupt(error):
            raise
        text = f"something whose repr raises {type(error).__name__}"
    text = text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."
    return f"{text} ({type(value).__name__})"
