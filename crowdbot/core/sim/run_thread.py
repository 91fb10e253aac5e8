"""The thread of a run that is stepped from outside, and its exchange with the session."""

from __future__ import annotations

import atexit
import queue
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from crowdbot.core.planning.host import STOP, PlannerHost
from crowdbot.core.planning.planner import Observation
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.record import record_robot
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task


class Exchange:
    """Passes observations out of the run's thread and commands into it."""

    def __init__(self) -> None:
        self._out: queue.SimpleQueue[Observation | Outcome | BaseException] = queue.SimpleQueue()
        self._in: queue.SimpleQueue[Command | None] = queue.SimpleQueue()
        self.closed = False

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Do nothing: the session's owner has this data already."""

    def step(self, obs: Observation) -> Command:
        """Planner's side: pass the observation and wait for the command."""
        if self.closed:
            return STOP
        self._out.put(obs)
        answer = self._in.get()
        return STOP if answer is None else answer

    def put(self, end: Outcome | BaseException) -> None:
        """Run's side: report the end."""
        self._out.put(end)

    def next(self) -> Observation | Outcome | BaseException:
        """Session's side: return the next observation or the end."""
        return self._out.get()

    def answer(self, command: Command) -> None:
        """Session's side: send the command."""
        self._in.put(command)

    def close(self) -> None:
        """Session's side: end the run at its next check."""
        self.closed = True
        self._in.put(None)


#: Active runs with their threads: Python must not kill one inside Drake at exit.
_GOING_ON: dict[Exchange, threading.Thread] = {}


@atexit.register
def _end_all() -> None:
    for exchange, thread in list(_GOING_ON.items()):
        exchange.close()
        thread.join()


def start_run(
    exchange: Exchange, setup: RunSetup, built: BuiltRun, host: PlannerHost
) -> threading.Thread:
    """Simulate in a separate thread, whose end the exchange reports.

    Args:
        exchange: the planner behind ``host``.
        setup, built, host: arguments of `record_robot`.
    """
    thread = threading.Thread(
        target=_simulate, args=(exchange, setup, built, host), name="session", daemon=True
    )
    _GOING_ON[exchange] = thread
    thread.start()
    return thread


def _simulate(exchange: Exchange, setup: RunSetup, built: BuiltRun, host: PlannerHost) -> None:
    """Run the thread."""
    try:
        exchange.put(record_robot(setup, built, host))
    except BaseException as error:  # raised again in the session's step
        exchange.put(error)
    finally:
        _GOING_ON.pop(exchange, None)


@contextmanager
def own_stdout() -> Iterator[None]:
    """Restore stdout, which the run redirects while the planner waits in its step."""
    mine = sys.stdout
    try:
        yield
    finally:
        sys.stdout = mine
