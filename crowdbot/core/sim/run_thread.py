"""The thread of a run that is stepped from outside, and its exchange with the session."""

from __future__ import annotations

import atexit
import math
import queue
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from crowdbot.core.planning.host import STOP, PlannerHost
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.record import record_robots
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task

#: Observations of the robots that go on, at one step of their planners, by name.
Seen = Mapping[str, Observation]


class Exchange:
    """Hands observations out of the run's thread and commands into it, for all robots at once."""

    def __init__(self) -> None:
        self._out: queue.SimpleQueue[Seen | Outcome | BaseException] = queue.SimpleQueue()
        self._in: queue.SimpleQueue[Mapping[str, Command]] = queue.SimpleQueue()
        self._look: Callable[[], Seen] = dict
        self._t, self._commands = -math.inf, dict[str, Command]()
        self.closed = False

    def planner(self, robot: str) -> Planner:
        """Return the planner of a robot, for the run."""
        return _Asking(self, robot)

    def begin(self, look: Callable[[], Seen]) -> None:
        """Called by the run: begin; ``look`` returns the present observations of all robots."""
        self._look = look

    def step(self, robot: str, obs: Observation) -> Command:
        """Called by the run: return a robot's command; the first robot of a step waits for all."""
        if self.closed:
            return STOP
        if obs.t > self._t:
            self._t = obs.t
            self._out.put({**self._look(), robot: obs})
            self._commands = dict(self._in.get())
        return self._commands.get(robot, STOP)

    def put(self, end: Outcome | BaseException) -> None:
        """Called by the run: report the end."""
        self._out.put(end)

    def next(self) -> Seen | Outcome | BaseException:
        """Called by the session: return the next observation or the end."""
        return self._out.get()

    def answer(self, commands: Mapping[str, Command]) -> None:
        """Called by the session: send the commands."""
        self._in.put(commands)

    def close(self) -> None:
        """Called by the session: end the run at its next check."""
        self.closed = True
        self._in.put({})


class _Asking:
    """Planner that waits for commands from the session."""

    def __init__(self, exchange: Exchange, robot: str) -> None:
        self._exchange, self._robot = exchange, robot

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Do nothing: the caller of the session knows all that already."""

    def step(self, obs: Observation) -> Command:
        """Return the next command given to the session."""
        return self._exchange.step(self._robot, obs)


#: Active runs with their threads: Python must not kill one inside Drake at exit.
_GOING_ON: dict[Exchange, threading.Thread] = {}


@atexit.register
def _end_all() -> None:
    for exchange, thread in list(_GOING_ON.items()):
        exchange.close()
        thread.join()


def start_run(
    exchange: Exchange, setup: RunSetup, builts: Mapping[str, BuiltRun]
) -> threading.Thread:
    """Simulate in a separate thread, whose end the exchange reports.

    Args:
        exchange: asks for the commands of all robots.
        setup, builts: as `record_robots` takes them.
    """
    thread = threading.Thread(
        target=_simulate, args=(exchange, setup, builts), name="session", daemon=True
    )
    _GOING_ON[exchange] = thread
    thread.start()
    return thread


def _simulate(exchange: Exchange, setup: RunSetup, builts: Mapping[str, BuiltRun]) -> None:
    """Run the thread."""
    hosts = {
        name: PlannerHost(exchange.planner(name), "session", built.model.limits)
        for name, built in builts.items()
    }
    try:
        exchange.put(record_robots(setup, builts, hosts))
    except BaseException as error:  # raised again where the session is stepped
        exchange.put(error)
    finally:
        _GOING_ON.pop(exchange, None)


@contextmanager
def own_stdout() -> Iterator[None]:
    """Restore stdout, which the run redirects while the planner waits in its step.

    It is read on entry, so the run must not go on before that.
    """
    mine = sys.stdout
    try:
        yield
    finally:
        sys.stdout = mine
