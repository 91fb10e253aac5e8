"""The rosbridge server over loopback, without a simulation behind it."""

from __future__ import annotations

import json
import random
import socket as sockets
from typing import Any

import cbor2
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection

from crowdbot.core.live.message import OfferedTopic, live_message
from crowdbot.core.live.rosbridge.server import Address, RosbridgeServer
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording import messages as ros
from crowdbot.core.types.motion import Command
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError
from tests.core.live.live_cases import call, client, clock, hear, say, serving, until

TWIST = {"linear": {"x": 0.25, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": -0.5}}
SCAN = SensorInfo(
    category="lidar", frame="front", mount=(0.0, 0.0, 0.0, 0.0), rate=10.0, shape=(4,),
    ros_type="sensor_msgs/msg/LaserScan", angles=np.linspace(-1.0, 1.0, 4), range_max=25.0,
)  # fmt: skip


def _scan() -> Any:
    assert SCAN.angles is not None
    ranges = np.array([1.5, 2.5, np.inf, 0.1])
    return live_message(
        "/scan", 3_000_000_004, ros.laser_scan(3_000_000_004, SCAN, SCAN.angles, ranges)
    )


def _cbor(socket: ClientConnection) -> Any:
    frame = socket.recv(timeout=30.0)
    assert isinstance(frame, bytes)
    return cbor2.loads(frame)


def _subscribed(server: RosbridgeServer, socket: ClientConnection, topic: str, **more: Any) -> None:
    say(socket, "subscribe", topic=topic, **more)
    until(lambda: server.wants(topic))


def test_a_subscriber_gets_json_without_infinity() -> None:
    with serving() as (server, _), client(server) as socket:
        _subscribed(server, socket, "/scan")
        server.publish([_scan()])
        message = hear(socket)
        assert message["op"] == "publish"
        assert message["topic"] == "/scan"
        assert message["msg"]["header"] == {
            "stamp": {"sec": 3, "nanosec": 4}, "frame_id": "front"
        }  # fmt: skip
        assert message["msg"]["ranges"] == [1.5, 2.5, None, pytest.approx(0.1)]


def test_ros_1_has_other_names() -> None:
    with serving(ros=1) as (server, _), client(server) as socket:
        _subscribed(server, socket, "/scan")
        server.publish([_scan()])
        head = hear(socket)["msg"]["header"]
        assert head == {"seq": 0, "stamp": {"secs": 3, "nsecs": 4}, "frame_id": "front"}


def test_cbor_has_typed_arrays_and_infinity() -> None:
    with serving() as (server, _), client(server) as socket:
        _subscribed(server, socket, "/scan", compression="cbor")
        server.publish([_scan()])
        message = _cbor(socket)
        tag = message["msg"]["ranges"]
        assert tag.tag == 85  # RFC 8746: float32, little-endian
        assert np.frombuffer(tag.value, "<f4").tolist() == [1.5, 2.5, np.inf, pytest.approx(0.1)]


@pytest.mark.parametrize("version", [1, 2])
def test_cbor_raw_has_the_serialised_message(version: int) -> None:
    scan = _scan()
    with serving(ros=version) as (server, _), client(server) as socket:
        _subscribed(server, socket, "/scan", compression="cbor-raw", fragment_size=10)
        server.publish([scan])
        message = _cbor(socket)["msg"]
        assert (message["secs"], message["nsecs"]) == (3, 4)
        expected = scan.data if version == 2 else ros.to_ros1(scan.data, scan.msgtype)
        assert message["bytes"] == expected


def test_long_text_comes_in_fragments() -> None:
    with serving() as (server, _), client(server) as socket:
        _subscribed(server, socket, "/scan", fragment_size=50)
        server.publish([_scan()])
        pieces = [hear(socket)]
        while len(pieces) < pieces[0]["total"]:
            pieces.append(hear(socket))
        assert {p["op"] for p in pieces} == {"fragment"}
        whole = json.loads("".join(p["data"] for p in pieces))
        assert whole["topic"] == "/scan"


def test_who_comes_late_gets_what_a_waiting_step_said() -> None:
    with serving() as (server, _), client(server) as first, client(server) as second:
        _subscribed(server, first, "/clock")
        server.publish([clock(5)])
        hear(first)
        say(second, "subscribe", topic="/clock")
        assert hear(second)["msg"] == {"clock": {"sec": 0, "nanosec": 5}}


def test_in_real_time_only_latched_messages_wait_for_who_comes_late() -> None:
    with serving(resend=False) as (server, _), client(server) as socket:
        server.open(
            [
                OfferedTopic("/clock", "rosgraph_msgs/msg/Clock"),
                OfferedTopic("/map", "x", latched=True),
            ]
        )
        still = live_message("/map", 1, ros.clock(1), latched=True)
        server.publish([clock(5), still])
        say(socket, "subscribe", topic="/clock")
        say(socket, "subscribe", topic="/map")
        assert hear(socket)["topic"] == "/map"


@pytest.mark.parametrize(
    "message",
    [
        TWIST,
        {"header": {"stamp": {"sec": 5, "nanosec": 0}, "frame_id": ""}, "twist": TWIST},
        {"header": {"stamp": {"secs": 5, "nsecs": 0}, "frame_id": ""}, "twist": TWIST},
    ],
)
def test_a_command_answers_the_step(message: dict[str, Any]) -> None:
    with serving() as (server, session), client(server) as socket:
        session.ask(5 * 10**9)
        say(socket, "advertise", topic="/cmd_vel", type="geometry_msgs/Twist")
        say(socket, "publish", topic="/cmd_vel", msg=message)
        assert session.answer(30.0, lambda: None) == Command(0.25, -0.5)


def test_cbor_from_a_client_is_understood() -> None:
    with serving() as (server, session), client(server) as socket:
        session.ask(0)
        socket.send(cbor2.dumps({"op": "publish", "topic": "/cmd_vel", "msg": TWIST}))
        assert session.answer(30.0, lambda: None) == Command(0.25, -0.5)


def test_a_driver_that_vanishes_makes_room() -> None:
    with serving() as (server, session), client(server) as other:
        with client(server) as first:
            say(first, "advertise", topic="/cmd_vel")
            until(lambda: session.driven)
            first.socket.shutdown(sockets.SHUT_RDWR)  # without a word
            until(lambda: not session.driven)
        session.ask(0)
        say(other, "publish", topic="/cmd_vel", msg=TWIST)
        assert session.answer(30.0, lambda: None) == Command(0.25, -0.5)


def _bad_frames(rng: random.Random, count: int) -> list[str | bytes]:
    """Garbage, half messages, and messages with a field that is wrong."""
    ops = ["subscribe", "publish", "advertise", "fragment", "call_service", "unsubscribe",
           "set_level", "auth", "status", "png", "", "unadvertise"]  # fmt: skip
    values: list[Any] = [None, True, -1, 1e308, "x", "/cmd_vel", [], {}, [[]], {"x": 1}, "9" * 50,
              2**80, {"linear": 3}, {"twist": []}, {"linear": {"x": "1"}},
              {"linear": {"x": None}}]  # fmt: skip
    frames: list[str | bytes] = []
    for _ in range(count):
        kind = rng.randrange(6)
        fields = ("topic", "id", "msg", "type", "service", "args", "data", "num", "total",
                  "throttle_rate", "queue_length", "fragment_size", "compression")  # fmt: skip
        message = {"op": rng.choice(ops), **{f: rng.choice(values) for f in rng.sample(fields, 4)}}
        text = json.dumps(message)
        if kind == 0:
            frames.append(rng.randbytes(rng.randrange(60)))
        elif kind == 1:
            frames.append(text[: rng.randrange(len(text))])
        elif kind == 2:
            frames.append(cbor2.dumps(message)[: rng.randrange(1, 80)])
        elif kind == 3:
            frames.append("[" * rng.randrange(5000))
        else:
            frames.append(text)
    return frames


@pytest.mark.parametrize("count", [400, pytest.param(10_000, marks=pytest.mark.slow)])
def test_garbage_neither_stops_nor_drives(count: int) -> None:
    rng = random.Random(20)
    with serving() as (server, session), client(server) as good:
        say(good, "advertise", topic="/cmd_vel")
        until(lambda: session.driven)
        session.ask(0)
        with client(server) as bad:
            say(bad, "set_level", level="none")
            for frame in _bad_frames(rng, count):
                bad.send(frame)
            assert call(bad, "/rosapi/get_time")["result"]
        say(good, "publish", topic="/cmd_vel", msg=TWIST)
        assert session.answer(30.0, lambda: None) == Command(0.25, -0.5)


def test_bytes_that_are_no_websocket_do_nothing() -> None:
    rng = random.Random(1)
    with serving() as (server, _):
        for size in (0, 1, 100, 5000):
            with sockets.create_connection(("127.0.0.1", server.port), timeout=30.0) as raw:
                raw.sendall(rng.randbytes(size))
        with client(server) as socket:
            raw_frame = b"\x81\xfe\xff"  # half a frame
            socket.socket.sendall(raw_frame)
            socket.socket.shutdown(sockets.SHUT_WR)
        with client(server) as socket:
            assert call(socket, "/rosapi/get_time")["result"]


def test_a_frame_that_is_too_long_ends_its_own_connection_only() -> None:
    with serving() as (server, _), client(server) as good:
        with client(server) as bad:
            bad.send("x" * (2**20 + 1))
            with pytest.raises(ConnectionClosed):
                bad.recv(timeout=30.0)
        assert call(good, "/rosapi/get_time")["result"]


@pytest.mark.slow
def test_two_thousand_come_and_go() -> None:
    with serving() as (server, session):
        for _ in range(2000):
            with client(server) as socket:
                say(socket, "subscribe", topic="/clock")
                say(socket, "advertise", topic="/cmd_vel")
        until(lambda: not server._connections)
        assert not server.wants("/clock")
        assert not session.driven


def test_who_does_not_read_does_not_hold_up_the_others() -> None:
    with serving() as (server, _), client(server) as deaf, client(server) as good:
        for socket in (deaf, good):
            _subscribed(server, socket, "/clock")
        until(lambda: sum("/clock" in c.feeds for c in server._connections) == 2)
        for k in range(2000):
            server.publish([clock(k)])
        for k in range(2000):
            assert hear(good)["msg"]["clock"]["nanosec"] == k


def test_a_foreign_website_is_sent_away() -> None:
    with serving() as (server, _):
        with pytest.raises(InvalidStatus, match="403"), client(server, origin="https://evil.test"):
            pass
        with client(server, origin="http://localhost:8080") as socket:
            assert call(socket, "/rosapi/get_time")["result"]


@pytest.mark.parametrize("path", ["", "?token=wrong", "?token=", "?token=%00"])
def test_who_does_not_know_the_token_is_sent_away(path: str) -> None:
    with serving(token="secret") as (server, _):  # noqa: S106
        with pytest.raises(InvalidStatus, match="401"), client(server, path):
            pass
        with client(server, "?token=secret", origin="https://any.test") as socket:
            assert call(socket, "/rosapi/get_time")["result"]


def test_an_address_that_is_taken_is_told() -> None:
    with serving() as (server, session), pytest.raises(InputError, match="cannot listen"):
        RosbridgeServer(session, Address(port=server.port), {})


def test_services_are_told_and_called() -> None:
    with serving() as (server, session), client(server) as socket:
        assert "/crowdbot/reset" in call(socket, "/rosapi/services")["values"]["services"]
        kind = call(socket, "/rosapi/service_type", {"service": "/crowdbot/reset"})
        assert kind["values"] == {"type": "std_srvs/srv/Trigger"}
        assert call(socket, "/crowdbot/set_seed", [5])["values"]["success"]
        assert session.take_request() == "reset"
        assert session.seed == 5
        assert call(socket, "/crowdbot/pause")["result"]
        assert session.paused
        wrong = call(socket, "/crowdbot/set_seed", {"seed": -1})
        assert not wrong["result"]
        assert "seed" in wrong["values"]
        assert not call(socket, "/none")["result"]


def test_rosapi_tells_topics_with_their_definitions() -> None:
    with serving() as (server, _), client(server) as socket:
        values = call(socket, "/rosapi/topics_and_raw_types")["values"]
        at = values["topics"].index("/clock")
        assert values["types"][at] == "rosgraph_msgs/msg/Clock"
        assert "builtin_interfaces/Time clock" in values["typedefs_full_text"][at]
        found = call(socket, "/rosapi/message_details", {"type": "nav_msgs/Odometry"})["values"]
        first = found["typedefs"][0]
        assert first["fieldnames"] == ["header", "child_frame_id", "pose", "twist"]
        covariance = next(t for t in found["typedefs"] if t["type"].endswith("PoseWithCovariance"))
        assert covariance["fieldarraylen"] == [-1, 36]


def test_parameters_are_kept() -> None:
    with serving() as (server, _), client(server) as socket:
        assert call(socket, "/rosapi/get_param", {"name": "/use_sim_time"})["values"] == {
            "value": "true"
        }
        call(socket, "/rosapi/set_param", {"name": "/a", "value": "1"})
        assert call(socket, "/rosapi/has_param", {"name": "/a"})["values"] == {"exists": True}
        assert "/a" in call(socket, "/rosapi/get_param_names")["values"]["names"]


def test_level_none_says_nothing() -> None:
    with serving() as (server, _), client(server) as socket:
        socket.send("garbage")
        assert hear(socket)["op"] == "status"
        say(socket, "set_level", level="none")
        socket.send("garbage")
        assert call(socket, "/rosapi/get_time")["op"] == "service_response"


def test_a_session_outlives_its_server() -> None:
    session = LiveSession()
    server = RosbridgeServer(session, Address(port=0), {})
    server.close()
    server.close()
    server.publish([clock(1)])
