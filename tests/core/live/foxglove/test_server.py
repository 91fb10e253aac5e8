"""The live view: the other side speaks Foxglove's protocol by hand."""

from __future__ import annotations

import json
import logging
import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

from crowdbot.core.live.admission import Admission
from crowdbot.core.live.foxglove.parameters import set_parameters
from crowdbot.core.live.foxglove.server import FoxgloveServer
from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.message import OfferedTopic, live_message
from crowdbot.core.live.services import services
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording import messages as ros
from crowdbot.core.types.motion import Command
from crowdbot.errors import InputError
from tests.core.live.live_cases import AT_MOST, clock, until
from tests.core.recording.recording_cases import header_of, random_run

TWIST = {"linear": {"x": 0.25, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": -0.5}}


@contextmanager
def _both(*robots: str) -> Iterator[tuple[FoxgloveServer, LiveSession, ClientConnection]]:
    """A connection and a client; ``robots``: names of several robots."""
    session = LiveSession(robots={name: LiveRobot(name) for name in robots or ("",)})
    connection = FoxgloveServer(session, "127.0.0.1", 0, services(session))
    try:
        connection.open(
            [
                OfferedTopic("/clock", "rosgraph_msgs/msg/Clock"),
                OfferedTopic("/map", "rosgraph_msgs/msg/Clock", True),
            ]
        )
        uri = f"ws://127.0.0.1:{connection.port}"
        speaks: Any = ["foxglove.sdk.v1"]
        with connect(uri, subprotocols=speaks, compression=None, close_timeout=0.5) as socket:
            yield connection, session, socket
    finally:
        connection.close()


def _hear(socket: ClientConnection, op: str) -> dict[str, Any]:
    while True:
        frame = socket.recv(timeout=AT_MOST)
        if isinstance(frame, str):
            message: dict[str, Any] = json.loads(frame)
            if message["op"] == op:
                return message


def _data(socket: ClientConnection, opcode: int) -> bytes:
    while True:
        frame = socket.recv(timeout=AT_MOST)
        if isinstance(frame, bytes) and frame[0] == opcode:
            return frame


def _channels(socket: ClientConnection) -> dict[str, int]:
    found: dict[str, int] = {}
    while len(found) < 2:
        found |= {c["topic"]: c["id"] for c in _hear(socket, "advertise")["channels"]}
    return found


def _subscribe(socket: ClientConnection, number: int, channel: int) -> None:
    wish = {"op": "subscribe", "subscriptions": [{"id": number, "channelId": channel}]}
    socket.send(json.dumps(wish))


def test_who_looks_gets_cdr() -> None:
    with _both() as (connection, _, socket):
        _subscribe(socket, 7, _channels(socket)["/clock"])
        until(lambda: connection.wants("/clock"))
        connection.publish([clock(3)])
        frame = _data(socket, 1)
        number, ns = struct.unpack_from("<IQ", frame, 1)
        assert (number, ns) == (7, 3)
        assert frame[13:] == clock(3).data


def test_who_comes_late_gets_the_map() -> None:
    with _both() as (connection, _, socket):
        still = live_message("/map", 5, ros.clock(5), latched=True)
        connection.publish([still])
        _subscribe(socket, 1, _channels(socket)["/map"])
        assert _data(socket, 1)[13:] == still.data


def test_what_a_planner_draws_is_a_marker_of_lines_or_a_text() -> None:
    with _both() as (connection, _, socket):
        header = header_of(random_run(2))
        connection.begin(header, {"robot": header})
        known = _channels(socket)
        while "/thoughts_marker" not in known:
            known |= {c["topic"]: c["id"] for c in _hear(socket, "advertise")["channels"]}
        _subscribe(socket, 4, known["/thoughts_marker"])
        until(lambda: connection.wants("/thoughts_marker"))
        connection.drawing(2.0, "robot", "tracks", np.array([[1.0], [2.0], [0.5], [0.0]]))
        connection.drawing(2.0, "another", "tracks", np.zeros((4, 1)))
        frame = _data(socket, 1)
        marker = ros.from_cdr(frame[13:], "visualization_msgs/msg/Marker")
        assert (marker.ns, marker.type) == ("tracks", marker.LINE_LIST)
        assert [(p.x, p.y) for p in marker.points] == [(1.0, 2.0), (1.5, 2.0)]
        connection.drawing(2.1, "robot", "why", np.array([[1.0], [2.0]]), ["waits"])
        values = ros.from_cdr(_data(socket, 1)[13:], "visualization_msgs/msg/Marker")
        assert (values.ns, values.type, values.text) == ("why", values.TEXT_VIEW_FACING, "waits")


def test_what_clients_send_does_not_reach_the_terminal_without_end(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    logger = logging.getLogger("foxglove.websocket.connected_client")
    monkeypatch.setattr(logger, "filters", [])
    with _both() as (_, _, socket):
        for number in range(60):
            socket.send(json.dumps({"op": f"\x1b[31m{number}"}))
        until(lambda: len(caplog.records) >= 20)
        socket.send(json.dumps({"op": "one more"}))
    texts = [r.getMessage() for r in caplog.records if r.name == logger.name]
    assert len(texts) == 20
    assert not any("\x1b" in text for text in texts)
    assert texts[-1].endswith("are not shown")


@pytest.mark.parametrize("encoding", ["json", "cdr"])
def test_client_publish_drives(encoding: str) -> None:
    cdr = ros.to_cdr(ros.twist(0.25, 0.0, -0.5))
    data = json.dumps(TWIST).encode() if encoding == "json" else cdr
    with _both() as (_, session, socket):
        session.ask(0)
        channel = {
            "id": 1, "topic": "/cmd_vel", "encoding": encoding,
            "schemaName": "geometry_msgs/msg/Twist",
        }  # fmt: skip
        socket.send(json.dumps({"op": "advertise", "channels": [channel]}))
        until(lambda: session.driven)
        for garbage in (b"", b"\xff" * 5):
            socket.send(struct.pack("<BI", 1, 1) + garbage)
        socket.send(struct.pack("<BI", 1, 1) + data)
        assert session.answer(AT_MOST, lambda: None) == Command(0.25, -0.5)
        socket.send(json.dumps({"op": "unadvertise", "channelIds": [1]}))
        until(lambda: not session.driven)


def test_services_reset_and_pause() -> None:
    with _both() as (_, session, socket):
        offered = {s["name"]: s["id"] for s in _hear(socket, "advertiseServices")["services"]}
        for name in ("/crowdbot/pause", "/crowdbot/reset"):
            head = struct.pack("<BIII", 2, offered[name], 1, 4) + b"json"
            socket.send(head + b"{}")
            answer = _data(socket, 3)
            assert json.loads(answer[17:])["success"]
        assert session.paused
        assert session.take_request() == "reset"


def _connect(connection: FoxgloveServer, **more: Any) -> ClientConnection:
    speaks: Any = ["foxglove.sdk.v1"]
    uri = f"ws://127.0.0.1:{connection.port}"
    made: ClientConnection = connect(
        uri, subprotocols=speaks, compression=None, close_timeout=0.5, **more
    )
    return made


@pytest.mark.parametrize("headers", [{"origin": "http://evil.test"}, {"host": "evil.test"}])
def test_foreign_websites_are_refused(headers: dict[str, str]) -> None:
    with _both() as (connection, _, _):
        host = headers.get("host")
        more: dict[str, Any] = {"origin": headers["origin"]} if host is None else {}
        uri = f"ws://{host or '127.0.0.1'}:{connection.port}"
        speaks: Any = ["foxglove.sdk.v1"]
        raw = socket.create_connection(("127.0.0.1", connection.port))
        with pytest.raises(InvalidStatus, match="403"), raw:
            connect(uri, sock=raw, subprotocols=speaks, **more)


def test_websites_of_this_machine_and_named_ones_are_admitted() -> None:
    session = LiveSession()
    admission = Admission(server="foxglove", origins=["https://app.test"])
    connection = FoxgloveServer(session, "127.0.0.1", 0, {}, admission=admission)
    try:
        for origin in ("http://localhost:8080", "https://app.test"):
            with _connect(connection, origin=origin) as viewer:
                assert _hear(viewer, "serverInfo")
    finally:
        connection.close()


def test_the_first_of_two_viewers_drives_until_it_leaves() -> None:
    channel = _advertised(1, "/cmd_vel")
    with _both() as (connection, session, first):
        first.send(json.dumps({"op": "advertise", "channels": [channel]}))
        until(lambda: session.driven)
        with _connect(connection) as second:
            second.send(json.dumps({"op": "advertise", "channels": [channel]}))
            head = struct.pack("<BI", 1, 1)
            second.send(head + json.dumps({"linear": {"x": 0.9}}).encode())
            until(lambda: session.counts.refused == 1)
            assert session.newest() == (None, False)
            first.send(head + json.dumps({"linear": {"x": 0.1}}).encode())
            until(lambda: session.newest()[0] == Command(0.1, 0.0))
            first.close()
            until(lambda: not session.driven)
            second.send(head + json.dumps({"linear": {"x": 0.9}}).encode())
            until(lambda: session.newest()[0] == Command(0.9, 0.0))


def test_an_address_that_is_taken_is_told() -> None:
    with _both() as (connection, session, _), pytest.raises(InputError, match="cannot listen"):
        FoxgloveServer(session, "127.0.0.1", connection.port, {})


def test_parameters_say_and_set() -> None:
    with _both() as (_, session, socket):
        session.scenario, session.scenarios = "one", ["one", "two"]
        socket.send(json.dumps({"op": "getParameters", "parameterNames": [], "id": "a"}))
        values = {p["name"]: p.get("value") for p in _hear(socket, "parameterValues")["parameters"]}
        while not values:
            found = _hear(socket, "parameterValues")["parameters"]
            values = {p["name"]: p.get("value") for p in found}
        assert values["scenario"] in ("one", "")
        wish = {"op": "setParameters", "parameters": [{"name": "paused", "value": True}]}
        socket.send(json.dumps({**wish, "id": "b"}))
        until(lambda: session.paused)
        wish["parameters"] = [{"name": "scenario", "value": "two"}, {"name": "seed", "value": 5}]
        socket.send(json.dumps(wish))
        until(lambda: session.seed == 5)
        assert session.requested == "two"


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("paused", 1, "true or false"),
        ("seed", -1, "whole number"),
        ("seed", 0.5, "whole number"),
        ("scenario", "none", "no scenario 'none'"),
        ("state", "arrived", "cannot be set"),
    ],
)
def test_a_parameter_that_is_wrong_is_told(name: str, value: Any, message: str) -> None:
    class Given:
        def __init__(self) -> None:
            self.name = name

        def get_value(self) -> Any:
            return value

    session = LiveSession(scenarios=["one"])
    assert message in set_parameters(session, [Given()])
    assert (session.paused, session.take_request()) == (False, "")


def test_a_spectator_sees_people_and_the_true_pose() -> None:
    run = random_run()
    with _both() as (connection, _, socket):
        header = header_of(run)
        connection.begin(header, {"robot": header})
        assert run.robot is not None
        assert run.agents is not None
        ids: dict[str, int] = {}
        while "/people_markers" not in ids or "/robot/pose" not in ids:
            ids |= {c["topic"]: c["id"] for c in _hear(socket, "advertise")["channels"]}
        _subscribe(socket, 1, ids["/people_markers"])
        until(lambda: connection.wants("/people_markers"))
        connection.sample(0.5, {"robot": run.robot[0].tolist()}, run.agents[0])
        data = _data(socket, 1)[13:]
        message = ros.from_cdr(data, "visualization_msgs/msg/MarkerArray")
        assert len(message.markers) == 1 + int(np.isfinite(run.agents[0, 0]).sum())


def _advertised(number: int, topic: str) -> dict[str, Any]:
    kind = "geometry_msgs/msg/Twist"
    return {"id": number, "topic": topic, "encoding": "json", "schemaName": kind}


def test_each_of_two_robots_is_driven_on_its_own_topic() -> None:
    with _both("a", "b") as (_, session, socket):
        session.ask(0, ["a", "b"])
        topics = ("/a/cmd_vel", "/b/cmd_vel", "/cmd_vel")
        channels = [_advertised(k, topic) for k, topic in enumerate(topics, 1)]
        socket.send(json.dumps({"op": "advertise", "channels": channels}))
        until(lambda: session.driven)
        for number, v in ((3, 0.9), (2, 0.2), (1, 0.1)):
            data = json.dumps({"linear": {"x": v}}).encode()
            socket.send(struct.pack("<BI", 1, number) + data)
        assert session.answer(AT_MOST, lambda: None, "a") == Command(0.1, 0.0)
        assert session.answer(AT_MOST, lambda: None, "b") == Command(0.2, 0.0)
        socket.send(json.dumps({"op": "unadvertise", "channelIds": [2]}))
        until(lambda: not session.is_driven("b"))
        assert session.is_driven("a")


def test_the_true_pose_of_each_of_two_robots_is_shown() -> None:
    header = header_of(random_run())
    with _both("a", "b") as (connection, _, socket):
        connection.begin(header, {"a": header, "b": header})
        topics = {"/a/robot/pose": (1.0, 2.0), "/b/robot/pose": (3.0, 4.0)}
        ids: dict[str, int] = {}
        while not set(topics) <= set(ids):
            ids |= {c["topic"]: c["id"] for c in _hear(socket, "advertise")["channels"]}
        for number, topic in enumerate(topics):
            _subscribe(socket, number, ids[topic])
        until(lambda: all(connection.wants(topic) for topic in topics))
        connection.sample(0.5, {"a": (1.0, 2.0, 0.0), "b": (3.0, 4.0, 0.0)}, None)
        seen = {}
        for _ in topics:
            frame = _data(socket, 1)
            pose = ros.from_cdr(frame[13:], "geometry_msgs/msg/PoseStamped").pose.position
            seen[list(topics)[struct.unpack_from("<I", frame, 1)[0]]] = (pose.x, pose.y)
        assert seen == topics
