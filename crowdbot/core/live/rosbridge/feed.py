"""One topic for one client: rate, format, and queue."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, cast, get_args

from crowdbot.core.live.message import LiveMessage
from crowdbot.core.live.rosbridge.bad_frame import BadFrame
from crowdbot.core.live.rosbridge.frames import Form

_LONGEST_THROTTLE = 3_600_000
#: Largest number of subscriptions of one client to one topic, and largest queue.
_MOST_IDS, _MOST_QUEUED = 64, 10_000


@dataclass(frozen=True, slots=True)
class SubscriptionOptions:
    """Rate, queue and format that a client requested for one topic.

    Attributes:
        throttle: smallest time between two messages, s.
        queue: largest queue; 0: unlimited.
        fragment: largest number of characters per fragment; 0: not fragmented.
    """

    throttle: float = 0.0
    queue: int = 0
    fragment: int = 0
    form: Form = "none"


def subscription_options(message: Mapping[str, Any]) -> tuple[SubscriptionOptions, str]:
    """Return the options of a ``subscribe``, and unsupported ones.

    Raises:
        BadFrame: a field is invalid.
    """
    throttle = _number(message, "throttle_rate", _LONGEST_THROTTLE)
    queue, fragment = _number(message, "queue_length"), _number(message, "fragment_size")
    queue = min(queue, _MOST_QUEUED)
    form = message.get("compression") or "none"
    if form in get_args(Form):
        pieces = fragment if form == "none" else 0
        return SubscriptionOptions(throttle / 1e3, queue, pieces, cast(Form, form)), ""
    why = f"compression '{form}' is not supported: none, cbor and cbor-raw are; none is used"
    return SubscriptionOptions(throttle / 1e3, queue, fragment, "none"), why


def _number(message: Mapping[str, Any], name: str, most: int = 2**31) -> int:
    value = message.get(name)
    if value is None:
        return 0
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= most:
        raise BadFrame(f"'{name}' must be a number from 0 on")
    return int(value)


Later = Callable[[float, Callable[[], None]], object]
Send = Callable[[LiveMessage, SubscriptionOptions], None]


class Feed:
    """One topic for one client, which may have several subscriptions."""

    def __init__(self, send: Send, later: Later, clock: Callable[[], float]) -> None:
        """Build a feed. ``later(s, f)`` calls ``f`` after a delay; ``clock`` is the time in s."""
        self._send, self._later, self._clock = send, later, clock
        self._by_id: dict[str, SubscriptionOptions] = {}
        self._waiting = deque[LiveMessage]()
        self._last = float("-inf")
        self._called = False
        self.options = SubscriptionOptions()

    def subscribe(self, name: str, options: SubscriptionOptions) -> None:
        """Add or replace one subscription.

        Raises:
            BadFrame: the client has too many to this topic.
        """
        if name not in self._by_id and len(self._by_id) >= _MOST_IDS:
            raise BadFrame(f"at most {_MOST_IDS} subscriptions to one topic")
        self._by_id[name] = options
        self._merge()

    def unsubscribe(self, name: str | None) -> bool:
        """Remove one or all subscriptions; return True if none is left."""
        if name is None:
            self._by_id.clear()
        self._by_id.pop(name or "", None)
        self._merge()
        return not self._by_id

    def _merge(self) -> None:
        """Merge subscriptions: the highest rate, and the latest format."""
        every = list(self._by_id.values()) or [SubscriptionOptions()]
        fragments = [w.fragment for w in every if w.fragment]
        self.options = SubscriptionOptions(
            min(w.throttle for w in every),
            min(w.queue for w in every),
            min(fragments, default=0) if every[-1].form == "none" else 0,
            every[-1].form,
        )

    def take(self, message: LiveMessage) -> None:
        """Send a message to the client at once, delayed, or not at all, by its rate and queue."""
        options = self.options
        if options.throttle <= 0.0:
            self._send(message, options)
        elif not self._waiting and self._clock() - self._last >= options.throttle:
            self._now(message)
        elif options.queue > 0:
            self._waiting.append(message)
            while len(self._waiting) > options.queue:
                self._waiting.popleft()
            self._call()

    def _now(self, message: LiveMessage) -> None:
        self._last = self._clock()
        self._send(message, self.options)

    def _call(self) -> None:
        if not self._called:
            self._called = True
            self._later(max(self._last + self.options.throttle - self._clock(), 0.0), self._due)

    def _due(self) -> None:
        self._called = False
        if self._waiting and self._by_id:
            self._now(self._waiting.popleft())
        if self._waiting and self._by_id:
            self._call()
