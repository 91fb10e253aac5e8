"""A client of a rosbridge server of others; the server here is a few lines of websockets."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.message import OfferedTopic, live_message
from crowdbot.core.live.rosbridge.client import RosbridgeClient
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording import messages as ros
from crowdbot.core.types.motion import Command
from crowdbot.errors import InputError
from tests.core.live.live_cases import clock, until

TWIST = {"linear": {"x": 0.25}, "angular": {"z": -0.5}}
OFFERS = [
    OfferedTopic("/map", "rosgraph_msgs/msg/Clock", latched=True),
    OfferedTopic("/clock", "rosgraph_msgs/msg/Clock"),
    OfferedTopic("/cam/image_raw", "sensor_msgs/msg/Image"),
]


class Others:
    """A server that notes what it hears, and answers each clock with a command."""

    def __init__(self) -> None:
        self.heard: list[dict[str, Any]] = []
        self.sockets: list[ServerConnection] = []

    def __call__(self, connection: ServerConnection) -> None:
        self.sockets.append(connection)
        try:
            for frame in connection:
                message = json.loads(frame)
                self.heard.append(message)
                if message["op"] == "publish" and message["topic"] == "/clock":
                    for garbage in ("x", "[]", '{"op": "publish", "topic": "/cmd_vel"}'):
                        connection.send(garbage)
                    answer = {"op": "publish", "topic": "/cmd_vel", "msg": TWIST}
                    connection.send(json.dumps(answer))
        except ConnectionClosed:
            pass

    def said(self, op: str) -> list[str]:
        return [m["topic"] for m in list(self.heard) if m["op"] == op]


@contextmanager
def _connected(**more: Any) -> Iterator[tuple[RosbridgeClient, LiveSession, Others]]:
    robots = {name: LiveRobot() for name in more.pop("robots", ("",))}
    others, session = Others(), LiveSession(robots=robots)
    with serve(others, "127.0.0.1", 0, compression=None) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        port = server.socket.getsockname()[1]
        options = {"ros": 2, "stamped": False, "external_clock": False, **more}
        client = RosbridgeClient(session, f"ws://127.0.0.1:{port}", **options)
        try:
            client.open(OFFERS)
            yield client, session, others
        finally:
            client.close()
            server.shutdown()
            thread.join()


def test_it_advertises_listens_and_is_driven() -> None:
    with _connected() as (client, session, others):
        assert session.driven
        client.publish([live_message("/map", 1, ros.clock(1), latched=True)])
        for k in range(20):
            session.ask(k)
            client.publish([clock(k)])
            assert session.answer(30.0, lambda: None) == Command(0.25, -0.5)
        assert others.said("advertise") == ["/map", "/clock"]
        assert others.said("subscribe") == ["/cmd_vel"]
        types = {m["topic"]: m["type"] for m in others.heard if "type" in m}
        assert types == {
            "/cmd_vel": "geometry_msgs/msg/Twist",
            "/map": "rosgraph_msgs/msg/Clock",
            "/clock": "rosgraph_msgs/msg/Clock",
        }


def test_it_listens_to_the_commands_of_each_robot() -> None:
    with _connected(robots=("a", "b")) as (_, session, others):
        until(lambda: session.driven and len(others.said("subscribe")) == 2)
        session.ask(0, ["a", "b"])
        for name, v in (("b", 0.2), ("a", 0.1)):
            answer = {"op": "publish", "topic": f"/{name}/cmd_vel", "msg": {"linear": {"x": v}}}
            others.sockets[0].send(json.dumps(answer))
        assert session.answer(30.0, lambda: None, "a") == Command(0.1, 0.0)
        assert session.answer(30.0, lambda: None, "b") == Command(0.2, 0.0)
        assert others.said("subscribe") == ["/a/cmd_vel", "/b/cmd_vel"]


def test_ros_1_types_and_stamped_commands() -> None:
    with _connected(ros=1, stamped=True) as (_, _, others):
        until(lambda: len(others.said("advertise")) == 2)
        types = {m["topic"]: m["type"] for m in others.heard if "type" in m}
        assert types["/cmd_vel"] == "geometry_msgs/TwistStamped"
        assert types["/map"] == "rosgraph_msgs/Clock"


def test_a_connection_that_breaks_is_made_again() -> None:
    with _connected() as (client, session, others):
        client.publish([live_message("/map", 1, ros.clock(1), latched=True)])
        until(lambda: "/map" in others.said("publish"))
        others.sockets[0].socket.shutdown(socket.SHUT_RDWR)
        until(lambda: len(others.sockets) == 2)
        until(lambda: others.said("publish").count("/map") == 2)  # latched: said again
        until(lambda: session.driven)
        session.ask(5)
        client.publish([clock(5)])
        assert session.answer(30.0, lambda: None) == Command(0.25, -0.5)


def test_nobody_there_is_told() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(InputError, match="no rosbridge server"):
        RosbridgeClient(
            LiveSession(), f"ws://127.0.0.1:{port}", ros=2, stamped=False, external_clock=False
        )
    with pytest.raises(InputError, match="no rosbridge server"):
        RosbridgeClient(LiveSession(), "nonsense", ros=2, stamped=False, external_clock=False)
