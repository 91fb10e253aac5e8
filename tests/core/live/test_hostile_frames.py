"""Frames that should stop the server for others: bounded before anything is built from them."""

from __future__ import annotations

import json
import random
import struct
from typing import Any

import cbor2
import pytest

from crowdbot.core.live.rosbridge.bad_frame import BadFrame
from crowdbot.core.live.rosbridge.cbor_frames import check_cbor, read_cbor
from crowdbot.core.live.rosbridge.fragments import MOST_SENT, Joiner, split
from crowdbot.core.live.rosbridge.pace import Pace, cost_of
from tests.core.live.live_cases import call, client, hear, say, serving

TWIST = {"op": "publish", "topic": "/cmd_vel", "msg": {"linear": {"x": 0.5}, "angular": {"z": 1}}}


def _colliding(count: int) -> bytes:
    """A map whose keys all have the hash 0."""
    keys = (cbor2.dumps(k * (2**61 - 1)) + b"\0" for k in range(1, count))
    return (
        b"\xba" + struct.pack(">I", count) + cbor2.dumps("op") + cbor2.dumps("x") + b"".join(keys)
    )


@pytest.mark.parametrize(
    "value", [TWIST, {"op": "x", "a": [1, -5, 2.5, None, True, b"12", "t", {"b": []}]},
              {"op": "x", "a": cbor2.CBORTag(85, b"\0" * 8)}]
)  # fmt: skip
def test_ordinary_frames_pass(value: Any) -> None:
    assert read_cbor(cbor2.dumps(value)) == value


def test_an_indefinite_length_passes() -> None:
    assert read_cbor(b"\xbf\x62op\x7f\x61a\x61b\xff\xff") == {"op": "ab"}


@pytest.mark.parametrize(
    "frame",
    [
        _colliding(3),
        cbor2.dumps({"op": "x", 1: 2}),
        cbor2.dumps({"op": {(1, 2): 3}}),
        b"\x81" * 100 + b"\0",
        b"\x9f" * 100,
        cbor2.dumps({"op": "x", "a": [0] * 5000}),
        b"\x9b" + b"\xff" * 8,
        b"\x7b" + b"\xff" * 8,
        cbor2.dumps({"op": "x", "n": 2**70}),
        cbor2.dumps({"op": "x", "t": cbor2.CBORTag(28, [1])}),
        cbor2.dumps({"op": "x"}) + b"\0",
        b"",
        b"\xff",
        b"\x1c",
    ],
)  # fmt: skip
def test_frames_outside_of_the_bounds_are_refused(frame: bytes) -> None:
    with pytest.raises(BadFrame):
        check_cbor(frame)


def test_random_bytes_never_end_otherwise() -> None:
    source = random.Random(7)
    whole = cbor2.dumps(TWIST)
    for _ in range(2000):
        frame = bytearray(whole)
        for _ in range(source.randrange(1, 4)):
            frame[source.randrange(len(frame))] = source.randrange(256)
        try:
            check_cbor(bytes(frame))
        except BadFrame:
            continue


def test_a_message_in_too_many_fragments_is_refused() -> None:
    assert len(list(split("x" * MOST_SENT, 1, 0))) == MOST_SENT
    with pytest.raises(BadFrame, match="fragment_size"):
        list(split("x" * (MOST_SENT + 1), 1, 0))


def test_fragments_are_counted_as_they_come() -> None:
    joiner = Joiner()
    piece = {"id": "a", "num": 0, "total": 3, "data": "x" * 600_000}
    for _ in range(3):
        assert joiner.add(piece) is None  # the same fragment again
    with pytest.raises(BadFrame, match="too long"):
        joiner.add({**piece, "num": 1})


def test_a_client_waits_when_it_sends_too_much() -> None:
    now = [0.0]
    pace = Pace(100.0, 10.0, lambda: now[0])
    assert pace.take(10.0) == 0.0
    assert pace.take(5.0) == pytest.approx(0.05)
    now[0] = 10.0
    assert pace.take(10.0) == 0.0  # not more than the burst is saved
    assert pace.take(1.0) > 0.0
    assert cost_of(b"x" * 1000) > cost_of("x" * 1000) > cost_of("x")


def test_a_topic_has_a_largest_number_of_subscriptions() -> None:
    with serving() as (server, _), client(server) as socket:
        for number in range(100):
            say(socket, "subscribe", topic="/clock", id=f"n{number}")
        assert "at most 64" in hear(socket)["msg"]


def test_a_frame_that_collides_is_answered_at_once() -> None:
    with serving() as (server, _), client(server) as bad, client(server) as good:
        bad.send(_colliding(50_000))
        assert "rosapi" in json.dumps(call(good, "/rosapi/services"))
        assert "keys of a map" in hear(bad)["msg"]
