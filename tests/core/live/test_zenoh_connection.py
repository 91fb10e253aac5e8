"""ROS 2 topics over zenoh; the other side is zenoh and rosbags alone."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zenoh
from rosbags.typesys import Stores, get_typestore

from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.message import OfferedTopic, live_message
from crowdbot.core.live.ros2_keys import Ros2Topic, attachment, gid_of, hash_in, in_distro
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.zenoh_connection import Network, ZenohConnection
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording import scenery
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError
from tests.core.live.live_cases import clock, until

CLOCK = "rosgraph_msgs/msg/Clock"
JAZZY: Any = get_typestore(Stores.ROS2_JAZZY)
#: Published with rmw_zenoh's own documentation.
STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


def _endpoint() -> str:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return f"tcp/127.0.0.1:{server.getsockname()[1]}"


@contextmanager
def _both(endpoint: str = "", **more: Any) -> Iterator[tuple[ZenohConnection, LiveSession, Any]]:
    """A connection that is the router, and a plain session of zenoh that connects to it."""
    robots = {name: LiveRobot() for name in more.pop("robots", ("",))}
    session, endpoint = LiveSession(robots=robots), endpoint or _endpoint()
    network = Network(endpoint=endpoint, router=True)
    connection = ZenohConnection(session, network, **{"external_clock": False, **more})
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("connect/endpoints", f'["{endpoint}"]')
    try:
        with zenoh.open(config) as other:
            yield connection, session, other
    finally:
        connection.close()


def test_hashes_are_those_that_are_published() -> None:
    assert hash_in("std_msgs/msg/String", "jazzy") == STRING
    assert hash_in("std_msgs/msg/String", "humble") == "TypeHashNotSupported"
    topic = Ros2Topic("/chatter", "std_msgs/msg/String", STRING)
    assert topic.key(2) == f"2/chatter/std_msgs::msg::dds_::String_/{STRING}"
    assert topic.token(2, "abc", 11, "MP", "talker") == (
        f"@ros2_lv/2/abc/0/11/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/{STRING}/"
        "::,10:,:,:,,"
    )


@pytest.mark.parametrize("distro", ["jazzy", "kilted", "lyrical"])
def test_a_type_that_grew_has_its_new_field(distro: Any) -> None:
    info = SensorInfo(
        category="ultrasound", frame="us1", mount=(0.0, 0.0, 0.0, 0.0), rate=10.0, shape=(1,),
        ros_type="sensor_msgs/msg/Range", angles=np.array([-0.1, 0.1]), range_max=4.0,
    )  # fmt: skip
    kind = "sensor_msgs/msg/Range"
    data = in_distro(ros.to_cdr(ros.range_reading(5, info, 1.5)), kind, distro)
    message: Any = get_typestore(Stores(f"ros2_{distro}")).deserialize_cdr(data, kind)
    assert (message.range, message.variance) == (1.5, 0.0)
    assert in_distro(b"same", kind, "humble") == b"same"


def test_an_attachment_has_33_bytes() -> None:
    data = attachment(7, 2**40, bytes(range(16)))
    assert len(data) == 33
    assert data[:8] == (7).to_bytes(8, "little")
    assert data[16] == 16
    assert data[17:] == bytes(range(16))


def test_a_listener_gets_messages_with_their_attachment() -> None:
    with _both() as (connection, _, other):
        connection.open([OfferedTopic("/clock", "rosgraph_msgs/msg/Clock")])
        assert not connection.wants("/clock")
        heard: list[Any] = []
        key = f"0/clock/rosgraph_msgs::msg::dds_::Clock_/{hash_in(CLOCK, 'jazzy')}"
        subscriber = other.declare_subscriber(key, heard.append)
        until(lambda: connection.wants("/clock"))
        connection.publish([clock(3_000_000_007)])
        until(lambda: len(heard) == 1)
        message = JAZZY.deserialize_cdr(heard[0].payload.to_bytes(), "rosgraph_msgs/msg/Clock")
        assert (message.clock.sec, message.clock.nanosec) == (3, 7)
        assert len(heard[0].attachment.to_bytes()) == 33
        subscriber.undeclare()
        until(lambda: not connection.wants("/clock"))


def test_who_comes_late_gets_the_map() -> None:
    from zenoh import ext

    with _both() as (connection, _, other):
        connection.open([OfferedTopic("/map", "rosgraph_msgs/msg/Clock", latched=True)])
        connection.publish([live_message("/map", 5, ros.clock(5), latched=True)])
        heard: list[Any] = []
        key = (
            f"0/map/rosgraph_msgs::msg::dds_::Clock_/{hash_in('rosgraph_msgs/msg/Clock', 'jazzy')}"
        )
        ext.declare_advanced_subscriber(other, key, heard.append, history=ext.HistoryConfig())
        until(lambda: len(heard) == 1)


def test_ros2_topic_list_sees_us() -> None:
    with _both() as (connection, _, other):
        connection.open([OfferedTopic("/clock", "rosgraph_msgs/msg/Clock")])

        def tokens() -> list[str]:
            return [str(r.ok.key_expr) for r in other.liveliness().get("@ros2_lv/**") if r.ok]

        until(lambda: any("/MP/%/%/crowdbot/%clock/" in t for t in tokens()))
        found = tokens()
        assert any(t.endswith("/NN/%/%/crowdbot") for t in found)
        listens = [t for t in found if "/MS/%/%/crowdbot/%cmd_vel/" in t]
        assert len(listens) == 2  # Twist and TwistStamped


@pytest.mark.parametrize("stamped", [False, True])
def test_lockstep_over_zenoh(stamped: bool) -> None:
    kind = "geometry_msgs/msg/TwistStamped" if stamped else "geometry_msgs/msg/Twist"
    with _both() as (connection, session, other):
        connection.open([OfferedTopic("/clock", "rosgraph_msgs/msg/Clock")])
        types = JAZZY.types
        vector, time = types["geometry_msgs/msg/Vector3"], types["builtin_interfaces/msg/Time"]
        command = Ros2Topic("/cmd_vel", kind, hash_in(kind, "jazzy"))
        publisher = other.declare_publisher(command.key(0))
        token = other.liveliness().declare_token(command.token(0, "me", 11, "MP", "driver"))
        until(lambda: session.driven)

        def on_clock(sample: Any) -> None:
            at = JAZZY.deserialize_cdr(sample.payload.to_bytes(), "rosgraph_msgs/msg/Clock").clock
            twist = types["geometry_msgs/msg/Twist"](
                vector(0.001 * at.sec, 0.0, 0.0), vector(0.0, 0.0, 0.25)
            )
            if stamped:
                head = types["std_msgs/msg/Header"](time(at.sec, at.nanosec), "")
                twist = types[kind](head, twist)
            publisher.put(bytes(JAZZY.serialize_cdr(twist, kind)))

        key = Ros2Topic(
            "/clock", "rosgraph_msgs/msg/Clock", hash_in("rosgraph_msgs/msg/Clock", "jazzy")
        )
        subscriber = other.declare_subscriber(key.key(0), on_clock)
        until(lambda: connection.wants("/clock"))
        for k in range(1, 200):
            session.ask(k * 10**9)
            connection.publish([clock(k * 10**9)])
            assert session.answer(30.0, lambda: None) == Command(0.001 * k, 0.25)
        subscriber.undeclare()
        token.undeclare()
        until(lambda: not session.driven)


def test_a_joystick_drives_by_zenoh() -> None:
    kind = "sensor_msgs/msg/Joy"
    types = JAZZY.types
    with _both() as (_, session, other):
        limits = RobotLimits(v_min=0.0, v_max=0.8, w_max=1.5, a_max=1.0, alpha_max=2.0)
        session.robots[""].limits = limits
        session.ask(0)
        name = next(iter(session.joysticks))
        joy = Ros2Topic(name, kind, hash_in(kind, "jazzy"))
        token = other.liveliness().declare_token(joy.token(0, "me", 11, "MP", "joy"))
        until(lambda: session.driven)
        head = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](0, 0), "")
        axes = np.array([0.5, 1.0], np.float32)
        message = types[kind](head, axes, np.zeros(0, np.int32))
        other.put(joy.key(0), bytes(JAZZY.serialize_cdr(message, kind)))
        assert session.answer(30.0, lambda: None) == Command(0.8, 0.75)
        token.undeclare()
        until(lambda: not session.driven)


def test_each_of_two_robots_is_driven_on_its_own_topic() -> None:
    kind = "geometry_msgs/msg/Twist"
    types = JAZZY.types
    vector = types["geometry_msgs/msg/Vector3"]
    with _both(robots=("a", "b")) as (_, session, other):
        session.ask(0, ["a", "b"])
        command = Ros2Topic("/b/cmd_vel", kind, hash_in(kind, "jazzy"))
        token = other.liveliness().declare_token(command.token(0, "me", 11, "MP", "driver"))
        until(lambda: session.is_driven("b"))
        assert not session.is_driven("a")
        twist = types[kind](vector(0.25, 0.0, 0.0), vector(0.0, 0.0, 0.5))
        other.put(command.key(0), bytes(JAZZY.serialize_cdr(twist, kind)))
        assert session.answer(30.0, lambda: None, "b") == Command(0.25, 0.5)
        assert session.answer(0.01, lambda: None, "a") is None
        token.undeclare()
        until(lambda: not session.is_driven("b"))


def test_the_first_of_two_publishers_drives_until_it_leaves() -> None:
    kind = "geometry_msgs/msg/Twist"
    vector = JAZZY.types["geometry_msgs/msg/Vector3"]
    with _both() as (_, session, other):
        command = Ros2Topic("/cmd_vel", kind, hash_in(kind, "jazzy"))
        texts = [command.token(0, "me", number, "MP", "driver") for number in (11, 12)]
        tokens = [other.liveliness().declare_token(text) for text in texts]
        until(lambda: session.driven)

        def put(number: int, v: float) -> None:
            twist = JAZZY.types[kind](vector(v, 0.0, 0.0), vector(0.0, 0.0, 0.0))
            about = attachment(1, 0, gid_of(texts[number]))
            data = bytes(JAZZY.serialize_cdr(twist, kind))
            other.put(command.key(0), data, attachment=about)

        put(0, 0.1)
        until(lambda: session.newest()[0] == Command(0.1, 0.0))
        put(1, 0.9)
        until(lambda: session.counts.refused == 1)
        assert session.newest()[0] == Command(0.1, 0.0)
        tokens[0].undeclare()

        def second_drives() -> bool:
            put(1, 0.9)
            return session.newest()[0] == Command(0.9, 0.0)

        until(second_drives)


def test_garbage_is_not_a_command() -> None:
    with _both() as (_, session, other):
        session.ask(0)
        for kind in ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"):
            key = Ros2Topic("/cmd_vel", kind, hash_in(kind, "jazzy")).key(0)
            for data in (b"", b"\0", b"\0\1\0\0" + b"\xff" * 20, b"x" * 1000):
                other.put(key, data)
        done = threading.Event()
        threading.Timer(0.3, done.set).start()
        done.wait()
        asked = session.robots[""].pending
        assert asked is not None
        assert asked.answer is None or asked.answer == Command(0.0, 0.0)


def test_the_clock_may_come_from_outside() -> None:
    with _both(external_clock=True) as (connection, session, other):
        connection.open([OfferedTopic("/clock", "rosgraph_msgs/msg/Clock")])
        assert not connection.wants("/clock")
        kind = "rosgraph_msgs/msg/Clock"
        other.put(Ros2Topic("/clock", kind, hash_in(kind, "jazzy")).key(0), clock(2 * 10**9).data)
        session.wait_for_clock(2.0)


def test_an_endpoint_without_a_router_is_told() -> None:
    with pytest.raises(InputError, match="cannot find a router"):
        ZenohConnection(LiveSession(), Network(endpoint=_endpoint()), external_clock=False)
    with pytest.raises(InputError, match="cannot be a router"):
        ZenohConnection(
            LiveSession(), Network(endpoint="nonsense", router=True), external_clock=False
        )


def test_what_is_latched_reaches_another_implementation() -> None:
    """`zenoh-ros2-sdk` asks late, with hashes that it computes itself, for what nav2 needs.

    Where it is installed: CROWDBOT_ZENOH_SDK names the Python of an environment that has it.
    """
    python = os.environ.get("CROWDBOT_ZENOH_SDK", "")
    if not Path(python).is_file():
        pytest.skip(
            "needs zenoh-ros2-sdk, in the environment whose Python CROWDBOT_ZENOH_SDK names"
        )
    walls = np.array([[0.0, -2.0, 10.0, -2.0], [0.0, 2.0, 10.0, 2.0]])
    frame = ros.transform(0, "base_link", "front", (0.1, 0.0, 0.2), 0.0)
    values = {
        "/map": scenery.occupancy_grid(1, walls),
        "/tf_static": ros.transforms([frame]),
        "/robot_description": ros.new("std_msgs/String", data="<robot name='r'/>"),
    }
    types = {topic: message.__msgtype__ for topic, message in values.items()}
    endpoint = _endpoint()
    host, _, port = endpoint.removeprefix("tcp/").partition(":")
    with _both(endpoint) as (connection, _, _):
        connection.open([OfferedTopic(t, kind, latched=True) for t, kind in types.items()])
        connection.publish(
            [live_message(t, 1, message, latched=True) for t, message in values.items()]
        )
        request = json.dumps({"topics": types, "definitions": _definitions(types.values())})
        argv = [python, str(Path(__file__).with_name("zenoh_sdk_listener.py")), host, port]
        done = subprocess.run(
            argv, input=request, text=True, stdout=subprocess.PIPE, timeout=300, check=True
        )
    heard = {m.pop("topic"): m for m in map(json.loads, done.stdout.splitlines())}
    grid = values["/map"].info
    assert heard == {
        "/map": {"width": grid.width, "height": grid.height},
        "/tf_static": {"children": ["front"]},
        "/robot_description": {"data": "<robot name='r'/>"},
    }


def _definitions(wanted: Iterable[str]) -> dict[str, str]:
    """The text of each type and of all that it consists of."""
    found: dict[str, str] = {}
    for name in wanted:
        text, _ = JAZZY.generate_msgdef(name, ros_version=2)
        first, *others = text.split("=" * 80 + "\nMSG: ")
        found[name] = first
        for other in others:
            kind, _, body = other.partition("\n")
            found[kind.replace("/", "/msg/") if "/msg/" not in kind else kind] = body
    return found
