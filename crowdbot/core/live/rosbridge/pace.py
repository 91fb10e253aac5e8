"""Rate limit for clients' messages, since one thread serves all clients."""

from __future__ import annotations

import time
from collections.abc import Callable

#: Cost of a byte of text and of CBOR, which takes longer to check, in messages.
_TEXT, _BINARY = 1 / 500, 1 / 50
Frame = str | bytes


def cost_of(frame: Frame) -> float:
    """Return the cost of a frame in messages: long frames count several times."""
    return 1.0 + len(frame) * (_TEXT if isinstance(frame, str) else _BINARY)


class Pace:
    """Token bucket that is filled at a constant rate."""

    def __init__(
        self, rate: float, burst: float, clock: Callable[[], float] = time.monotonic
    ) -> None:
        """Allow ``rate`` messages per second, and ``burst`` of them at once."""
        self._rate, self._burst, self._clock = rate, burst, clock
        self._left, self._filled = burst, clock()

    def take(self, cost: float) -> float:
        """Take tokens; return the time to wait before the next message, s."""
        now = self._clock()
        self._left = min(self._burst, self._left + (now - self._filled) * self._rate) - cost
        self._filled = now
        return max(-self._left / self._rate, 0.0)
