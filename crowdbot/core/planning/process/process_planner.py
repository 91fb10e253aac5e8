"""A planner in a separate process, with the usual interface."""

from __future__ import annotations

import contextlib
import math
import os
import signal
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any, NoReturn

from crowdbot.core.planning.containment.offer import (
    contained_request,
    kernel_offer,
)
from crowdbot.core.planning.description import read_description
from crowdbot.core.planning.host import RESET_LIMIT
from crowdbot.core.planning.planner import NoValidCommand, Observation
from crowdbot.core.planning.process.messages import ObservationWriter, reserve, reset_message
from crowdbot.core.planning.process.planner_line import (
    LineClosed,
    LineTimeout,
    PlannerLine,
    WrongAnswer,
)
from crowdbot.core.planning.process.process_plan import ProcessPlan, check_plan
from crowdbot.core.planning.process.server_handle import POOL, ServerGone, ServerHandle
from crowdbot.core.planning.process.serving import PROTOCOL
from crowdbot.core.planning.process.shared_memory import SharedMemory, has_shared_memory
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task
from crowdbot.errors import InputError, PlannerError, printable
from crowdbot.old_names import say_old_names

#: Seconds for a process to exit by itself, and to be gone after closing its connection.
_LEAVES, _DIES = 1.0, 0.3
_GIB = 1 << 30
#: Largest number of characters kept of a planner's error.
_LONGEST_REASON = 2000
#: Stands for an exit code if the fork server was ended too.
_KILLED_ALL = -(1 << 16)


class ProcessLostError(PlannerError):
    """A planner's process died, hung or sent an invalid reply."""


class ProcessDiedError(ProcessLostError):
    """A planner's process died: by itself, by a signal, or out of memory."""


class ProcessPlanner:
    """A planner in a separate process, called through messages.

    Its process ends with `close`, on any failure, and with our own process.

    Args:
        plan: the program.

    Raises:
        InputError, PlannerError: it cannot be loaded, or would not be contained and has to be.
    """

    def __init__(self, plan: ProcessPlan) -> None:
        self._plan, self._step = plan, 0
        check_plan(plan)
        self._server: ServerHandle | None = None
        self._why = ""
        try:
            self._memory = SharedMemory() if has_shared_memory() else None
            self._line = self._start()
        except OSError as error:
            raise InputError(f"{plan.title}: its process cannot be started: {error}") from None
        hello = self._ask("load", self._hello(), RESET_LIMIT, "hello")
        try:
            if hello.get("protocol") != PROTOCOL:
                self._fail(
                    f"hello: it speaks protocol {hello.get('protocol')!r:.40}, not {PROTOCOL}"
                )
            self.description = read_description(hello, plan.title)
        except InputError:
            self.close()
            raise
        self._shares = hello.get("arrays") == "shared" and self._memory is not None
        self._write = ObservationWriter(self._memory if self._shares else None)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Build the planner and reset it, see `Planner.reset`.

        Raises:
            PlannerError: it failed.
        """
        message = reset_message(task, limits, sensors, seed)
        if self._shares and self._memory is not None:
            reserve(self._memory, sensors)
            message["memory"] = self._memory.size
        self._ask("return from reset", message, RESET_LIMIT, "ready")

    def step(self, obs: Observation) -> Command:
        """Like `Planner.step`.

        Raises:
            NoValidCommand: it has no valid command.
            PlannerError: it failed.
        """
        self._step += 1
        message = self._write.message(self._step, obs)
        answer = self._ask("return from step", message, Watchdog().limit, "command", "stop")
        self._pass_on(answer, obs)
        if answer["type"] == "stop":
            raise NoValidCommand
        return self._command(answer)

    def close(self) -> None:
        """End the planner's process, which gets a second to exit, and all its children."""
        if self._server is not None:
            self._line.tell({"type": "close"})
            self._end(grace=_LEAVES)

    def __del__(self) -> None:
        """Like `close`, for a planner that was not closed."""
        if getattr(self, "_server", None) is not None:
            self.close()

    # ----------------------------------------------------------------- its process
    def _start(self) -> PlannerLine:
        """Start the process, with one retry if the server was ended meanwhile."""
        try:
            return self._started()
        except ServerGone:
            return self._started()

    def _started(self) -> PlannerLine:
        plan = self._plan
        server = POOL.take(own=plan.own_side is not None)
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        output, theirs_output = os.pipe()
        memory = [] if self._memory is None else [self._memory.descriptor]
        try:
            server.has_imported(plan.preload)
            server.start(
                {
                    "what": plan.own_side,
                    "command": list(plan.command),
                    "folder": plan.folder or _here(),
                    "memory": plan.memory,
                    "contain": contained_request(plan.needs),
                },
                [theirs_in, theirs_out, *memory, theirs_output],
            )
        except BaseException:
            for one in (ours_out, ours_in, output):
                os.close(one)
            server.sweep()
            raise
        finally:
            for one in (theirs_in, theirs_out, theirs_output):
                os.close(one)
        self._server = server
        return PlannerLine(ours_out, ours_in, output, plan.title, server.descriptor)

    def _hello(self) -> dict[str, Any]:
        return {
            "type": "hello",
            "protocol": PROTOCOL,
            "crowdbot": metadata.version("crowdbot"),
            "parameters": dict(self._plan.parameters) if self._plan.command else {},
        }

    def _ask(
        self, doing: str, message: dict[str, Any], limit: float, *reply_type: str
    ) -> dict[str, Any]:
        """Send a request and return a reply of the expected type.

        Anything else ends the process.
        """
        try:
            answer = self._line.ask(message, limit)
        except LineTimeout:
            where = self._end(ask=True)[1]
            self._raise(f"did not {doing} within {limit:g} s; its process was ended{where}")
        except LineClosed:
            raise ProcessDiedError(printable(f"{self._plan.title}: {self._gone(doing)}")) from None
        except WrongAnswer as error:
            self._fail(f"{error}")
        except BaseException:  # the user's interrupt
            self.close()
            raise
        if self._plan.own_side is not None:
            say_old_names(answer.get("old_names", ()))
        if answer.get("type") == "error":
            self._failed(answer)
        if answer.get("type") not in reply_type or answer.get("step", 0) != message.get("step", 0):
            self._fail(f"answered {answer.get('type')!r:.40} to '{message['type']}'")
        return answer

    def _failed(self, answer: Mapping[str, Any]) -> NoReturn:
        """Raise the planner's own error, as reported by it."""
        self.close()
        text = printable(str(answer.get("text", ""))[:_LONGEST_REASON])
        if "MemoryError" in text and self._plan.memory is not None:
            text += f"; the limit of its memory is {self._plan.memory / _GIB:g} GiB"
        if "PermissionError" in text and kernel_offer().contained:
            text += (
                "; a planner reads what it declares ('data', 'files', 'libraries'), writes to its "
                "home folder, and has no network unless its document asks for it"
            )
        if "BdbQuit" in text:
            text += "; to use a debugger, let the planner run --in-process"
        error = InputError if answer.get("kind") == "input" else PlannerError
        raise error(text if answer.get("whole") is True else f"{self._plan.title}: {text}")

    def _gone(self, doing: str) -> str:
        """Describe how a process without a reply ended."""
        status, where = self._end(grace=_DIES)
        if self._why:
            how = f"{self._why}; it was ended, with all that it started"
        elif status is None:
            how = "its process closed the descriptors of its messages"
        elif status == _KILLED_ALL:
            how = "its process was ended, and with it the one that had started it"
        elif status < 0:
            how = f"its process was ended by signal {-status} ({_signal(-status)})"
        else:
            how = f"its process ended with exit code {status}"
        return f"did not {doing}: {how}{where}"

    def _end(self, *, grace: float = 0.0, ask: bool = False) -> tuple[int | None, str]:
        """End the process: return its exit code (None if killed now) and its last output."""
        server, self._server = self._server, None
        assert server is not None
        try:
            report = server.end(grace=grace, ask=ask)
            status: int | None = report["status"]
            self._why = str(report["why"])
            POOL.give_back(server)
        except ServerGone:
            status = _KILLED_ALL
            server.sweep()
        self._line.drain()
        words = self._line.last_words
        self._line.close()
        memory, self._memory = self._memory, None
        if memory is not None:
            memory.close()
        return status, f" ({words})" if words else ""

    def _fail(self, problem: str) -> NoReturn:
        """End the process and raise an error.

        Raises:
            PlannerError: always.
        """
        if self._server is not None:
            self._end()
        self._raise(problem)

    def _raise(self, problem: str) -> NoReturn:
        raise ProcessLostError(printable(f"{self._plan.title}: {problem}"))

    # --------------------------------------------------------------------- answers
    def _pass_on(self, answer: Mapping[str, Any], obs: Observation) -> None:
        signals = answer.get("signals") or ()
        try:
            for name, value in signals:
                obs.log(name, value)
        except (TypeError, ValueError):
            self._fail(f"step: 'signals' are pairs of a name and a number, not {signals!r:.80}")
        drawings = answer.get("drawings") or ()
        try:
            for name, rows, *text in drawings:
                obs.draw(name, rows, *text)
        except (TypeError, ValueError) as error:
            self._fail(
                "step: 'drawings' are lists of a name, rows and perhaps texts, not "
                f"{drawings!r:.80}: {error}"
            )

    def _command(self, answer: Mapping[str, Any]) -> Command:
        numbers = [answer.get("v"), answer.get("w"), answer.get("vy", 0.0)]
        fine = all(isinstance(x, int | float) and not isinstance(x, bool) for x in numbers)
        if not fine or not all(math.isfinite(x) for x in numbers if x is not None):
            self._fail(f"step: v, w and vy are finite numbers, not {numbers!r:.80}")
        return Command(*(float(x) for x in numbers if x is not None))


def _here() -> str:
    """Return the working directory, to which file names are relative; empty if it is gone."""
    with contextlib.suppress(OSError):
        return str(Path.cwd())
    return ""


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return "unknown"
