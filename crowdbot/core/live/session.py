"""A live session: shared state of the simulation and its clients.

The simulation and the connections have separate threads; one lock protects all state.
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
#: Interval at which a wait checks for interruptions, s.
_LOOK = 0.05
#: A command with a stamp older than the current step by more than this belongs to another step.
_ROUNDING = 1_000


@dataclass
class LiveCounts:
    """Counters of a run.

    Attributes:
        steps: planner steps so far.
        missed: steps without a new command in time.
        refused: commands that were not finite, came from a client that does not drive, or were for
            another step.
        lag, most_lag: delay of the simulation behind its clock, s.
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
    """State shared by the simulation and its connections.

    Attributes:
        interrupted: True if the user stopped the run.
        counts: counters of the current run.
        state, scenario, run, seed, t: facts about it.
        robot, pose, twist: its robot's state: name of the robot; x, y, yaw and v, w, vy by
            odometry.
        scenarios: ids of the available scenarios; ``wanted`` is the requested one.
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
        """Start a run."""
        with self._changed:
            self.scenario, self.seed, self.t = scenario, seed, 0.0
            if self.run:  # requests from before the first run are kept
                self._latest, self._fresh, self._clock = None, False, -math.inf
            self.run += 1
            self.counts, self.state = LiveCounts(), "waiting"
            self._asked = None
            self._request = ""

    def finish(self, state: State) -> None:
        """End the run."""
        with self._changed:
            self.state = state
            self._changed.notify_all()

    @property
    def must_stop(self) -> bool:
        """Return True if the run has to stop early."""
        return bool(self._request) or self.interrupted()

    def ask(self, ns: int) -> None:
        """From now on, commands are for the step at ``ns``."""
        with self._changed:
            self._asked, self._listeners = _Asked(ns), False

    def answer(self, budget: float, listened: Callable[[], None]) -> Command | None:
        """Wait for the command of the current step; return None if there is none in time.

        Args:
            budget: s to wait.
            listened: callback for new subscribers during the wait.
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
        """Wait for a driving client, at most this many seconds; return True if there is one."""
        with self._changed:
            self._wait(lambda: self._driver is not None, time.monotonic() + patience)
            return self._driver is not None

    def newest(self) -> tuple[Command | None, bool]:
        """Return the latest command, and True if it is new since the last call."""
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
        """Return when the external clock is at least ``t``, s."""
        with self._changed:
            self._wait(lambda: self._clock >= t - 1e-9, math.inf)

    def sleep(self, until: float) -> None:
        """Sleep until a time of `time.monotonic`, or until the run has to end."""
        with self._changed:
            self._wait(lambda: False, until)

    def wait_for_request(self) -> Request:
        """Wait for a request for another run; return nothing when the user stops."""
        with self._changed:
            self._wait(lambda: False, math.inf)
            return self.take_request()

    def take_request(self) -> Request:
        """Return the pending request once."""
        with self._changed:
            wanted, self._request = self._request, ""
            return wanted

    def _wait(self, done: Callable[[], bool], until: float) -> None:
        """Wait for a condition, a time, or the end of the run; requires the lock."""
        while not done() and not self.must_stop:
            left = until - time.monotonic()
            if left <= 0.0:
                return
            self._changed.wait(min(left, _LOOK))

    # ------------------------------------------------------------------ connections tell
    def drive(self, who: Hashable) -> bool:
        """Return True if this client may drive; the first client keeps control until it leaves."""
        with self._changed:
            if self._driver is None:
                self._driver = who
                self._changed.notify_all()
            return self._driver == who

    def leave(self, who: Hashable) -> None:
        """Handle a client that left or stopped driving."""
        with self._changed:
            if self._driver == who:
                self._driver = None
                self._changed.notify_all()

    @property
    def driven(self) -> bool:
        """Return True if a client drives."""
        return self._driver is not None

    def command(self, who: Hashable, command: Command, stamp: int | None = None) -> str:
        """Take a client's command.

        Args:
            who: the client.
            command: m/s, rad/s.
            stamp: stamp of the message, ns; None or 0 if it has none.

        Returns:
            Why the command is refused; empty if accepted.
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
        """Handle a new subscriber."""
        with self._changed:
            self._listeners = True
            self._changed.notify_all()

    def clock(self, t: float) -> None:
        """Set the external clock to ``t``, s; it never goes back."""
        with self._changed:
            if t > self._clock and math.isfinite(t):
                self._clock = t
                self._changed.notify_all()

    def pause(self, wanted: bool) -> None:
        """Pause the run before its next step, or resume it."""
        with self._changed:
            self._paused, self._steps = wanted, 0
            self._changed.notify_all()

    def step(self, count: int) -> int:
        """Take this many steps and pause again; return the number of the last one."""
        with self._changed:
            self._paused = True
            self._steps += count
            self._changed.notify_all()
            return self.counts.steps + self._steps

    def ask_for(self, request: Request, seed: int | None = None) -> None:
        """Stop the run and start another: the same scenario again, or the next one."""
        with self._changed:
            self._request = request
            self.seed = self.seed if seed is None else seed
            self._changed.notify_all()

    def load(self, scenario: str) -> None:
        """Stop the run and start another scenario."""
        with self._changed:
            self.wanted = scenario
        self.ask_for("load")

    @property
    def paused(self) -> bool:
        """Return True if the run is paused."""
        return self._paused
