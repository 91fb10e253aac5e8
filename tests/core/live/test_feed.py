"""Subscriptions: throttle, queue, fragments; what waits for a client that does not read."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.live.message import LiveMessage
from crowdbot.core.live.rosbridge.bad_frame import BadFrame
from crowdbot.core.live.rosbridge.feed import Feed, SubscriptionOptions, subscription_options
from crowdbot.core.live.rosbridge.fragments import Joiner, split
from crowdbot.core.live.rosbridge.outbox import Outbox
from tests.core.live.live_cases import clock


class Time:
    """A clock that is moved by hand."""

    def __init__(self) -> None:
        self.now = 0.0
        self._calls: list[tuple[float, Callable[[], None]]] = []

    def later(self, after: float, call: Callable[[], None]) -> None:
        self._calls.append((self.now + after, call))

    def go(self, to: float) -> None:
        while self._calls and min(t for t, _ in self._calls) <= to:
            due = min(self._calls, key=lambda c: c[0])
            self._calls.remove(due)
            self.now = max(self.now, due[0])
            due[1]()
        self.now = to


def _feed(**fields: Any) -> tuple[Feed, Time, list[int]]:
    sent: list[int] = []
    time = Time()

    def send(message: LiveMessage, options: SubscriptionOptions) -> None:
        del options
        sent.append(message.ns)

    feed = Feed(send, time.later, lambda: time.now)
    feed.subscribe("a", SubscriptionOptions(**fields))
    return feed, time, sent


def test_without_wishes_everything_is_sent_at_once() -> None:
    feed, _, sent = _feed()
    for k in range(5):
        feed.take(clock(k))
    assert sent == [0, 1, 2, 3, 4]


def test_throttled_messages_are_left_out() -> None:
    feed, time, sent = _feed(throttle=0.095)
    for k in range(100):
        time.go(k * 0.01)
        feed.take(clock(k))
    assert sent == [0, 10, 20, 30, 40, 50, 60, 70, 80, 90]


def test_throttled_messages_wait_in_a_queue_that_loses_the_oldest() -> None:
    feed, time, sent = _feed(throttle=1.0, queue=2)
    for k in range(5):
        feed.take(clock(k))
    assert sent == [0]
    time.go(10.0)
    assert sent == [0, 3, 4]
    feed.take(clock(9))
    assert sent == [0, 3, 4, 9]


def test_what_waits_is_not_sent_after_the_end_of_a_subscription() -> None:
    feed, time, sent = _feed(throttle=1.0, queue=5)
    for k in range(3):
        feed.take(clock(k))
    assert feed.unsubscribe("a")
    time.go(10.0)
    assert sent == [0]


def test_of_two_subscriptions_the_more_eager_one_counts() -> None:
    feed, _, sent = _feed(throttle=1.0)
    feed.subscribe("b", SubscriptionOptions())
    feed.take(clock(1))
    feed.take(clock(2))
    assert sent == [1, 2]
    assert not feed.unsubscribe("b")
    feed.take(clock(3))
    feed.take(clock(4))
    assert sent == [1, 2, 3]


@pytest.mark.parametrize("field", ["throttle_rate", "queue_length", "fragment_size"])
@pytest.mark.parametrize("value", [-1, "1", True, [], float("nan"), float("inf"), 2**70])
def test_wishes_are_numbers_from_0_on(field: str, value: object) -> None:
    with pytest.raises(BadFrame, match=field):
        subscription_options({field: value})


def test_fragments_are_off_for_cbor() -> None:
    assert subscription_options({"compression": "cbor", "fragment_size": 10})[0].fragment == 0
    assert subscription_options({"compression": "none", "fragment_size": 10})[0].fragment == 10


def test_an_unknown_compression_is_told_and_left_out() -> None:
    options, remark = subscription_options({"compression": "png"})
    assert options.form == "none"
    assert "png" in remark


@given(st.text(min_size=1, max_size=200), st.integers(1, 50), st.randoms())
def test_fragments_come_together_in_any_order(text: str, size: int, random: Any) -> None:
    pieces = list(split(text, size, 7))
    if len(pieces) == 1:
        assert pieces == [text]
        return
    random.shuffle(pieces)
    joiner = Joiner()
    answers = [joiner.add(json.loads(piece)) for piece in pieces]
    assert answers[:-1] == [None] * (len(pieces) - 1)
    assert answers[-1] == text


def test_a_message_in_fragments_has_a_largest_size() -> None:
    joiner = Joiner()
    piece = {"id": "1", "data": "x" * 2**19, "total": 3}
    joiner.add({**piece, "num": 0})
    joiner.add({**piece, "num": 1})
    with pytest.raises(BadFrame, match="too long"):
        joiner.add({**piece, "num": 2})


def test_fragments_that_never_end_do_not_pile_up() -> None:
    joiner = Joiner()
    for k in range(1000):
        joiner.add({"id": str(k), "data": "x", "num": 0, "total": 2})
    assert len(joiner._open) == 8


@pytest.mark.parametrize("change", [{"num": 5}, {"num": -1}, {"total": 10**9}, {"data": 3},
                                    {"num": True}, {"id": None}, {"total": "2"}])  # fmt: skip
def test_a_fragment_must_be_one(change: dict[str, Any]) -> None:
    with pytest.raises(BadFrame):
        Joiner().add({"id": "1", "data": "x", "num": 0, "total": 2, **change})


def test_who_does_not_read_loses_the_oldest() -> None:
    async def fill() -> None:
        outbox = Outbox(most=100)
        for k in range(50):
            outbox.put(f"{k:010d}")
        assert len(outbox) == 10
        assert outbox.lost == 40
        assert await outbox.get() == "0000000040"
        other = Outbox()
        other.put("status")
        for k in range(5):
            other.put(f"topic {k}", "/t", 2)
        assert [await other.get() for _ in range(3)] == ["status", "topic 3", "topic 4"]

    asyncio.run(fill())
