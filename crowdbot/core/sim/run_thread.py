"""The thread of a run that is stepped from outside, and what passes between it and its session."""

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
    """Hands observations out of the run's thread and commands into it."""

    def __init__(self) -> None:
        self._out: queue.SimpleQueue[Observation | Outcome | BaseException] = queue.SimpleQueue()
        self._in: queue.SimpleQueue[Command | None] = queue.SimpleQueue()
        self.closed = False

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Nothing: whoever holds the session knows all that already."""

    def step(self, obs: Observation) -> Command:
        """The planner's side: show what is seen, wait for the answer."""
        if self.closed:
            return STOP
        self._out.put(obs)
        answer = self._in.get()
        return STOP if answer is None else answer

    def put(self, end: Outcome | BaseException) -> None:
        """The run's side: it is over."""
        self._out.put(end)

    def next(self) -> Observation | Outcome | BaseException:
        """The session's side: what comes next."""
        return self._out.get()

    def answer(self, command: Command) -> None:
        """The session's side: go on."""
        self._in.put(command)

    def close(self) -> None:
        """The session's side: end the run at its next look."""
        self.closed = True
        self._in.put(None)


#: Runs that go on, with their threads: at its exit Python must not cut one off inside Drake.
_GOING_ON: dict[Exchange, threading.Thread] = {}


@atexit.register
def _end_all() -> None:
    for exchange, thread in list(_GOING_ON.items()):
        exchange.close()
        thread.join()


def start_run(
    exchange: Exchange, setup: RunSetup, built: BuiltRun, host: PlannerHost
) -> threading.Thread:
    """Simulate in a thread of its own, whose end the exchange tells.

    Args:
        exchange: the planner behind ``host``.
        setup, built, host: as `record_robot` takes them.
    """
    thread = threading.Thread(
        target=_simulate, args=(exchange, setup, built, host), name="session", daemon=True
    )
    _GOING_ON[exchange] = thread
    thread.start()
    return thread


def _simulate(exchange: Exchange, setup: RunSetup, built: BuiltRun, host: PlannerHost) -> None:
    """The run's thread."""
    try:
        exchange.put(record_robot(setup, built, host))
    except BaseException as error:  # raised again where the session is stepped
        exchange.put(error)
    finally:
        _GOING_ON.pop(exchange, None)


@contextmanager
def own_stdout() -> Iterator[None]:
    """Undo that the run sends what a planner prints to stderr: the planner waits in its step."""
    mine = sys.stdout
    try:
        yield
    finally:
        sys.stdout = mine
