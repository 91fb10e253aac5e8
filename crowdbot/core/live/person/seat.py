"""The place of the person in a run: one page at a time, with a dead man's switch, in real time.

Each tenth of a second the page reports that it is active, and its stick's position. When it loses
the focus, is hidden, falls silent or disconnects, the stick is centred at once: the robot brakes,
the walking person stands. Unless only the focus is lost, the run is paused `GRACE` seconds later
until a page is back, which its record says.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import Literal

from crowdbot.core.live.person.stick import CENTRED, Stick
from crowdbot.core.live.session import LiveSession
from crowdbot.core.types.motion import Command

#: Why no hand is on the stick; empty: one is.
Away = Literal["", "not in focus", "hidden", "disconnected", "silent"]
#: After this time without a word a page counts as gone; then, how long the run goes on, s.
SILENT, GRACE = 0.5, 1.0
#: A run that is later than this does not hurry to catch up, which no hand could follow, s.
LATE = 0.1
#: How long a command of a program that is not a page counts, s of real time.
HOLD = 0.5
_LOOK = 0.02  # s


@dataclass
class SeatLog:
    """The events at the person's place in one recording.

    Attributes:
        steps: how often the stick was read; ``centred``: how often with no hand on it.
        stops: time and reason of each moment when the hand left the stick.
        waits: time, real duration and reason of each wait; s.
        delayed: how much real time the run lost in total where the computer was too slow, s.
        latencies: from a key to the step that used it, as the page measured it, ms.
    """

    steps: int = 0
    centred: int = 0
    stops: list[tuple[float, str]] = field(default_factory=list)
    waits: list[tuple[float, float, str]] = field(default_factory=list)
    delayed: float = 0.0
    latencies: list[float] = field(default_factory=list)


class Seat:
    """The person's page that drives, and the position of its stick.

    Pages call `sit`, `attend`, `move`, `begin` and `leave`, in another thread than the simulation,
    which calls `pace` and `take`. The session knows other drivers, such as a program by rosbridge.

    Attributes:
        log: of the current recording.
        on_taken: callback for the first use of a position: its number, time of the step.
        why_waiting: why the run waits; empty: it goes on.
    """

    def __init__(self, session: LiveSession, robot: str = "", rate: float = 1.0) -> None:
        """Offer the seat of a robot, given by its namespace, at ``rate`` s per s."""
        self.session, self._robot, self._rate = session, robot, rate
        self.log = SeatLog()
        self.on_taken: Callable[[int, float], object] = lambda *_: None
        self.why_waiting = "preparing"
        self._lock = threading.Lock()
        self._page: Hashable | None = None
        self._stick = CENTRED
        self._away: Away = "disconnected"
        self._since = self._heard = time.monotonic()
        self._begun = self._held = False
        self._zero: float | None = None
        self._t = 0.0
        self._used = 0
        self._outside = -HOLD

    # ---------------------------------------------------------------------------- pages tell
    def sit(self, page: Hashable) -> bool:
        """Return True if a page drives: the first one does until it leaves."""
        if not self.session.drive(page, self._robot):
            return False
        with self._lock:
            if self._page != page:
                self._page, self._stick, self._used = page, CENTRED, 0
                self._leave_stick("not in focus")
            self._heard = time.monotonic()
        return True

    def attend(self, page: Hashable, away: Away) -> None:
        """Store if the driving page is attended, and why not."""
        with self._lock:
            if self._page != page:
                return
            self._heard = time.monotonic()
            if away:
                self._leave_stick(away)
            else:
                self._away = ""

    def move(self, page: Hashable, stick: Stick) -> bool:
        """Store a position of the stick; return False if the page does not drive."""
        with self._lock:
            if self._page != page:
                self.session.refuse()
                return False
            self._heard = time.monotonic()
            if not self._away and stick.number > self._stick.number:
                self._stick = stick
        return True

    def begin(self, page: Hashable) -> None:
        """Start the waiting run, because the driving page asks for it."""
        with self._lock:
            if self._page == page and self.why_waiting == "not begun":
                self._begun = True

    def leave(self, page: Hashable) -> None:
        """Handle a page that is gone."""
        with self._lock:
            if self._page == page:
                self._leave_stick("disconnected")
                self._page = None
        self.session.leave(page)

    def latency(self, page: Hashable, ms: float) -> None:
        """Record a latency that the driving page measured, ms."""
        with self._lock:
            if self._page == page and 0.0 <= ms < 1e5:
                self.log.latencies.append(ms)

    def drives(self, page: Hashable) -> bool:
        """Return True if this page drives."""
        return self._page == page

    @property
    def taken(self) -> bool:
        """Return True if someone drives, in a page or from outside."""
        return self._page is not None or self._from_outside

    def _leave_stick(self, away: Away) -> None:
        if self._away in ("", "not in focus") and away != self._away:
            self._since = time.monotonic()
        self._away = away
        self._stick = Stick(self._stick.number, yaw=self._stick.yaw)

    # ----------------------------------------------------------------------- the simulation asks
    def pace(self, t: float) -> None:
        """Wait until the step at ``t`` (s) is due in real time, and until someone drives."""
        if t < self._t:  # another recording
            self.log, self._begun, self._zero, self._held = SeatLog(), False, None, False
        self._t = t
        self._wait_for_a_person(t)
        now = time.monotonic()
        if self._zero is None:
            self._zero = now - t / self._rate
        late = now - (self._zero + t / self._rate)
        if late > LATE:
            self._zero += late
            self.log.delayed += late
        self.session.sleep(self._zero + t / self._rate)

    def take(self, t: float) -> Stick | Command:
        """Return the stick's command at a step, or that of an external program that drives."""
        self.log.steps += 1
        command, fresh = self.session.newest(self._robot)
        if self._from_outside:
            now = time.monotonic()
            self._outside = now if fresh else self._outside
            held = command is not None and now - self._outside <= HOLD
            return command if held and command is not None else self._centred(t, "silent")
        with self._lock:
            away, stick = self._absence(), self._stick
        if away:
            return self._centred(t, away, stick)
        self._held = True
        if stick.number != self._used:
            self._used = stick.number
            self.on_taken(stick.number, t)
        return stick

    def _centred(self, t: float, why: str, stick: Stick = CENTRED) -> Stick:
        self.log.centred += 1
        if self._held:
            self._held = False
            self.log.stops.append((t, why))
        return Stick(stick.number, yaw=stick.yaw)

    @property
    def _from_outside(self) -> bool:
        driver = self.session.robots[self._robot].driver
        return driver is not None and driver != self._page

    def _absence(self) -> Away:
        silent = time.monotonic() - self._heard > SILENT
        if silent and self._away in ("", "not in focus"):
            self._leave_stick("silent")
            self._since = self._heard
        return self._away

    def _missing(self) -> str:
        """Return why the run has to wait; empty: it goes on."""
        if self.session.paused:
            return "paused"
        if self._from_outside:
            return ""
        with self._lock:
            if not self._begun:
                return "not begun"
            away = self._absence()
            alone = away not in ("", "not in focus")
            return away if alone and time.monotonic() - self._since > GRACE else ""

    def _wait_for_a_person(self, t: float) -> None:
        begin, why = time.monotonic(), ""
        while not self.session.must_stop and (now := self._missing()):
            why = why or now
            self.why_waiting = now
            self.session.sleep(time.monotonic() + _LOOK)
        self.why_waiting = ""
        if not why:
            return
        waited = time.monotonic() - begin
        if self._zero is not None:
            self._zero += waited
            self.log.waits.append((t, waited, why))
