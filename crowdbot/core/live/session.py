"""A live session: what the simulation and those who are connected share.

The simulation asks in its own thread; connections tell in theirs. All of it is behind one lock.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from typing import Literal

from crowdbot.core.types.ending import Ending
from crowdbot.core.types.motion import Command

Request = Literal["", "reset", "next", "load"]
State = Literal["waiting", "running", "paused", "ended"] | Ending
#: How often a wait looks whether the run was interrupted, s.
_LOOK = 0.05
#: A command whose stamp is older than the step that is asked, by more than this, answers another.
_ROUNDING = 1_000


@dataclass
class LiveCounts:
    """What is told about a run.

    Attributes:
        steps: planner steps so far.
        missed: steps for which no new command came in time.
        refused: commands that were not finite, came from somebody who does not drive, or answered
            another step.
        lag, most_lag: how far the simulation is behind the time it should keep, s.
    """

    steps: int = 0
    missed: int = 0
    refused: int = 0
    lag: float = 0.0
    most_lag: float = 0.0


@dataclass
class _Asked:
    """The step that waits for its command."""

    ns: int
    answer: Command | None = None


@dataclass
class LiveSession:
    """Shared by the simulation and its connections.

    Attributes:
        interrupted: whether the user wants to end.
        counts: of the run that is going on.
        state, scenario, run, seed, t: of the same.
        robot, pose, twist: of the same: name of the robot; x, y, yaw and v, w, vy by odometry.
        scenarios: ids of those that can be loaded; ``wanted`` is the one that somebody chose.
    """

    interrupted: Callable[[], bool] = lambda: False
    counts: LiveCounts = field(default_factory=LiveCounts)
    state: State = "waiting"
    scenario: str = ""
    run: int = 0
    seed: int = 0
    t: float = 0.0
    robot: str = ""
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    twist: tuple[float, float, float] = (0.0, 0.0, 0.0)
    scenarios: Sequence[str] = ()
    wanted: str = ""
    _changed: threading.Condition = field(default_factory=threading.Condition)
    _driver: Hashable | None = None
    _asked: _Asked | None = None
    _latest: Command | None = None
    _fresh: bool = False
    _paused: bool = False
    _steps: int = 0
    _clock: float = -math.inf
    _request: Request = ""
    _listeners: bool = False

    # ------------------------------------------------------------------ the simulation asks
    def begin(self, scenario: str, seed: int) -> None:
        """A run begins."""
        with self._changed:
            self.scenario, self.seed, self.t = scenario, seed, 0.0
            if self.run:  # what was said before the first run begins counts
                self._latest, self._fresh, self._clock = None, False, -math.inf
            self.run += 1
            self.counts, self.state = LiveCounts(), "waiting"
            self._asked = None
            self._request = ""

    def finish(self, state: State) -> None:
        """The run ended."""
        with self._changed:
            self.state = state
            self._changed.notify_all()

    @property
    def must_stop(self) -> bool:
        """Whether the run is to end before its end."""
        return bool(self._request) or self.interrupted()

    def ask(self, ns: int) -> None:
        """From now on a command answers the step at ``ns``."""
        with self._changed:
            self._asked, self._listeners = _Asked(ns), False

    def answer(self, budget: float, listened: Callable[[], None]) -> Command | None:
        """Wait for the command of the step that was asked; None where none came in time.

        Args:
            budget: s to wait.
            listened: called when somebody began to listen meanwhile, who has to be told.
        """
        until = time.monotonic() + budget
        while True:
            with self._changed:
                asked = self._asked
                assert asked is not None
                self._wait(lambda: asked.answer is not None or self._listeners, until)  # noqa: B023
                if asked.answer is not None or not self._listeners:
                    self._asked = None
                    return asked.answer
                self._listeners = False
            listened()

    def wait_for_driver(self, patience: float) -> bool:
        """Wait until somebody wants to drive, at most so many seconds; whether there is one."""
        with self._changed:
            self._wait(lambda: self._driver is not None, time.monotonic() + patience)
            return self._driver is not None

    def newest(self) -> tuple[Command | None, bool]:
        """The latest command, and whether it came since the last call."""
        with self._changed:
            fresh, self._fresh = self._fresh, False
            return self._latest, fresh

    def wait_while_paused(self) -> None:
        """Return when the next step may be taken."""
        with self._changed:
            self._wait(lambda: not self._paused or self._steps > 0, math.inf)
            self._steps = max(self._steps - 1, 0)
            self.state = "paused" if self._paused else "running"
            self._changed.notify_all()

    def wait_for_clock(self, t: float) -> None:
        """Return when the clock outside shows at least ``t``, s."""
        with self._changed:
            self._wait(lambda: self._clock >= t - 1e-9, math.inf)

    def sleep(self, until: float) -> None:
        """Sleep until a time of `time.monotonic`, or until the run is to end."""
        with self._changed:
            self._wait(lambda: False, until)

    def wait_for_request(self) -> Request:
        """Wait until somebody wants another run; nothing when the user wants to end."""
        with self._changed:
            self._wait(lambda: False, math.inf)
            return self.take_request()

    def take_request(self) -> Request:
        """What somebody wanted, once."""
        with self._changed:
            wanted, self._request = self._request, ""
            return wanted

    def _wait(self, done: Callable[[], bool], until: float) -> None:
        """Wait for something, for a time, or for the end of the run; the lock is held."""
        while not done() and not self.must_stop:
            left = until - time.monotonic()
            if left <= 0.0:
                return
            self._changed.wait(min(left, _LOOK))

    # ------------------------------------------------------------------ connections tell
    def drive(self, who: Hashable) -> bool:
        """Somebody wants to drive; whether he may: the first one does, until he leaves."""
        with self._changed:
            if self._driver is None:
                self._driver = who
                self._changed.notify_all()
            return self._driver == who

    def leave(self, who: Hashable) -> None:
        """Somebody is gone, or does not drive any more."""
        with self._changed:
            if self._driver == who:
                self._driver = None
                self._changed.notify_all()

    @property
    def driven(self) -> bool:
        """Whether somebody drives."""
        return self._driver is not None

    def command(self, who: Hashable, command: Command, stamp: int | None = None) -> str:
        """Somebody commands.

        Args:
            who: he.
            command: m/s, rad/s.
            stamp: of the message, ns; None or 0 where it has none.

        Returns:
            Why the command is refused; empty where it is taken.
        """
        why = self._taken(who, command, stamp)
        if why:
            with self._changed:
                self.counts.refused += 1
        return why

    def _taken(self, who: Hashable, command: Command, stamp: int | None) -> str:
        if not all(math.isfinite(x) for x in command):
            return "a command must be finite"
        if not self.drive(who):
            return "another client drives; its commands count until it leaves"
        with self._changed:
            asked = self._asked
            if asked is not None and stamp and stamp < asked.ns - _ROUNDING:
                return "the command's stamp is older than the step that waits for one"
            self._latest, self._fresh = command, True
            if asked is not None and asked.answer is None:
                asked.answer = command
            self._changed.notify_all()
        return ""

    def listened(self) -> None:
        """Somebody began to listen."""
        with self._changed:
            self._listeners = True
            self._changed.notify_all()

    def clock(self, t: float) -> None:
        """The clock outside shows ``t``, s; it never goes back."""
        with self._changed:
            if t > self._clock and math.isfinite(t):
                self._clock = t
                self._changed.notify_all()

    def pause(self, wanted: bool) -> None:
        """Hold the run before its next step, or let it go on."""
        with self._changed:
            self._paused, self._steps = wanted, 0
            self._changed.notify_all()

    def step(self, count: int) -> int:
        """Take so many steps and hold again; returns the number of the last one."""
        with self._changed:
            self._paused = True
            self._steps += count
            self._changed.notify_all()
            return self.counts.steps + self._steps

    def ask_for(self, request: Request, seed: int | None = None) -> None:
        """End the run and begin another one: the same scenario again, or the next one."""
        with self._changed:
            self._request = request
            self.seed = self.seed if seed is None else seed
            self._changed.notify_all()

    def load(self, scenario: str) -> None:
        """End the run and begin one of another scenario."""
        with self._changed:
            self.wanted = scenario
        self.ask_for("load")

    @property
    def paused(self) -> bool:
        """Whether the run is held."""
        return self._paused
