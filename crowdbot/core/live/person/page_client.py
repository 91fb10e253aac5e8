"""One connected page: its requests, and the messages queued for it."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from typing import Any, get_args

from crowdbot.core.live.person.seat import Away, Seat
from crowdbot.core.live.person.stick import stick_of
from crowdbot.core.live.rosbridge.outbox import Outbox
from crowdbot.errors import InputError

#: Messages per second and at once that a page may send; no hand sends more.
_PER_SECOND, _BURST = 400.0, 800.0
_MOST_LATENCIES = 100


class PageClient:
    """A page; used only in the server's thread."""

    def __init__(self, seat: Seat) -> None:
        """Connect a page, which takes the seat if that is free."""
        self._seat = seat
        self.outbox = Outbox()
        self.sending = False
        self._budget, self._before = _BURST, time.monotonic()
        self._ops: dict[str, Callable[[Mapping[str, Any]], None]] = {
            "stick": self._stick,
            "here": self._here,
            "sit": lambda _: self.say_role(seat.sit(self)),
            "begin": lambda _: seat.begin(self),
            "pause": self._pause,
            "ping": lambda message: self.say("pong", at=_finite(message, "at")),
            "latency": self._latency,
        }
        self.say_role(seat.sit(self))

    def take(self, frame: str | bytes) -> None:
        """Handle a message of the page; reply with an error if it is invalid."""
        if not self._may():
            return
        try:
            message = json.loads(frame)
            op = self._ops.get(message.get("op", "")) if isinstance(message, dict) else None
            if op is None:
                raise InputError("the page sent a message of an unknown kind")
            op(message)
        except InputError as error:
            self.say("error", text=str(error))
        except (ValueError, TypeError, RecursionError) as error:
            self.say("error", text=f"not understood: {type(error).__name__}")

    def _may(self) -> bool:
        """Return True if the page is within its message rate; counts one message."""
        now = time.monotonic()
        self._budget = min(_BURST, self._budget + _PER_SECOND * (now - self._before))
        self._before = now
        if self._budget < 1.0:
            return False
        self._budget -= 1.0
        return True

    def say(self, op: str, **fields: Any) -> None:
        """Send a message."""
        self.outbox.put(json.dumps({"op": op, **fields}))

    def say_role(self, drives: bool) -> None:
        """Send the page its role: driving or watching."""
        self.say("role", drives=drives, taken=drives or self._seat.taken)

    def close(self) -> None:
        """Handle a disconnected page."""
        self._seat.leave(self)

    @property
    def waiting(self) -> bool:
        """Return True if messages are queued."""
        return self.sending or len(self.outbox) > 0

    def _stick(self, message: Mapping[str, Any]) -> None:
        if not self._seat.move(self, stick_of(message)):
            self.say_role(drives=False)

    def _here(self, message: Mapping[str, Any]) -> None:
        away = message.get("away", "")
        if away not in get_args(Away):
            raise InputError("'away' says why no hand is on the stick")
        self._seat.attend(self, away)

    def _pause(self, message: Mapping[str, Any]) -> None:
        if self._seat.drives(self):
            self._seat.session.pause(message.get("on") is True)

    def _latency(self, message: Mapping[str, Any]) -> None:
        given = message.get("ms")
        if not isinstance(given, list) or len(given) > _MOST_LATENCIES:
            raise InputError("'ms' is a short list of numbers")
        for ms in given:
            self._seat.latency(self, _finite({"ms": ms}, "ms"))


def _finite(message: Mapping[str, Any], name: str) -> float:
    value = message.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e15:
        raise InputError(f"'{name}' is a number")
    return float(value)
