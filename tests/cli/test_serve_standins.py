"""Stand-ins for nav2: drive through rosbridge, and through zenoh, with the topics that it needs."""

from __future__ import annotations

import json
import math
import socket
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
import zenoh
from rosbags.typesys import Stores, get_typestore
from ruamel.yaml import YAML

from crowdbot import cli
from crowdbot.core.live.ros2_keys import Ros2Topic, hash_in
from crowdbot.core.recording.recording import Recording
from tests.cli.test_serve import SHORT, _connected, _free_port, _say
from tests.core.live.standin import HEARS, PurePursuit

pytestmark = pytest.mark.slow
JAZZY: Any = get_typestore(Stores.ROS2_JAZZY)


def _over_rosbridge(port: int, planner: PurePursuit) -> None:
    with _connected(port) as client:
        for topic in (*HEARS, "/crowdbot/status"):
            _say(client, "subscribe", planner.topic(topic) if topic in HEARS else topic)
        command = planner.topic("/cmd_vel")
        _say(client, "advertise", command, type="geometry_msgs/Twist")
        for frame in client:
            message = json.loads(frame)
            topic, body = message.get("topic"), message.get("msg")
            if topic == "/map":
                about = body["info"]
                planner.on_map(
                    about["origin"]["position"]["y"], about["height"], about["resolution"]
                )
            elif topic == "/tf":
                for t in body["transforms"]:
                    at, turn = t["transform"]["translation"], t["transform"]["rotation"]
                    frames = t["header"]["frame_id"], t["child_frame_id"]
                    planner.on_tf(*frames, at["x"], at["y"], turn["z"], turn["w"])
            elif topic == planner.topic("/odom"):
                planner.on_odom(body["twist"]["twist"]["linear"]["x"])
            elif topic == planner.topic("/scan"):
                planner.on_scan([math.inf if r is None else r for r in body["ranges"]])
            elif topic == "/clock":
                planner.seen.add("/clock")
                v, w = planner.command()
                twist = {"linear": {"x": v}, "angular": {"z": w}}
                _say(client, "publish", command, msg=twist)
            elif topic == "/crowdbot/status" and body["state"] in ("arrived", "timeout"):
                return


class _OverZenoh:
    """The same as a node of ROS 2 would, with TwistStamped; until it is closed."""

    def __init__(self, endpoint: str, planner: PurePursuit) -> None:
        self._planner = planner
        config = zenoh.Config()
        config.insert_json5("mode", '"client"')
        config.insert_json5("scouting/multicast/enabled", "false")
        config.insert_json5("connect/endpoints", f'["{endpoint}"]')
        self.session = self._when_there(config)
        kind = "geometry_msgs/msg/TwistStamped"
        command = Ros2Topic("/cmd_vel", kind, hash_in(kind, "jazzy"))
        self._publisher = self.session.declare_publisher(command.key(0))
        from zenoh import ext

        self._kept: list[Any] = []
        for name, msgtype in HEARS.items():
            key = Ros2Topic(name, msgtype, hash_in(msgtype, "jazzy")).key(0)
            hear: Callable[[Any], None] = self._heard(msgtype)
            past = ext.HistoryConfig() if name == "/map" else None
            self._kept.append(
                ext.declare_advanced_subscriber(self.session, key, hear, history=past)
            )
        token = command.token(0, "standin", 11, "MP", "standin")
        self._kept.append(self.session.liveliness().declare_token(token))

    @staticmethod
    def _when_there(config: zenoh.Config) -> zenoh.Session:
        end = time.monotonic() + 600.0
        while True:
            try:
                return zenoh.open(config)
            except zenoh.ZError:
                assert time.monotonic() < end
                time.sleep(0.1)

    def _heard(self, msgtype: str) -> Callable[[Any], None]:
        def hear(sample: Any) -> None:
            self._take(msgtype, JAZZY.deserialize_cdr(sample.payload.to_bytes(), msgtype))

        return hear

    def _take(self, msgtype: str, m: Any) -> None:
        planner = self._planner
        if msgtype.endswith("OccupancyGrid"):
            planner.on_map(m.info.origin.position.y, m.info.height, m.info.resolution)
        elif msgtype.endswith("TFMessage"):
            for t in m.transforms:
                at, turn = t.transform.translation, t.transform.rotation
                planner.on_tf(t.header.frame_id, t.child_frame_id, at.x, at.y, turn.z, turn.w)
        elif msgtype.endswith("Odometry"):
            planner.on_odom(m.twist.twist.linear.x)
        elif msgtype.endswith("LaserScan"):
            planner.on_scan(m.ranges.tolist())
        else:
            planner.seen.add("/clock")
            self._answer(m.clock)

    def _answer(self, at: Any) -> None:
        types, kind = JAZZY.types, "geometry_msgs/msg/TwistStamped"
        vector = types["geometry_msgs/msg/Vector3"]
        v, w = self._planner.command()
        twist = types["geometry_msgs/msg/Twist"](vector(v, 0.0, 0.0), vector(0.0, 0.0, w))
        stamp = types["builtin_interfaces/msg/Time"](at.sec, at.nanosec)
        message = types[kind](types["std_msgs/msg/Header"](stamp, "base_link"), twist)
        self._publisher.put(bytes(JAZZY.serialize_cdr(message, kind)))


def _serve(
    out: Path, capsys: pytest.CaptureFixture[str], name: str, port: int, *more: str,
    what: Sequence[str] = SHORT,
) -> dict[str, Any]:  # fmt: skip
    argv = [*what, "--out", str(out), "--record", "used"]
    code = cli.main(["serve", *argv, "--port", str(port), "--json", "--name", name, *more])
    shown = capsys.readouterr()
    assert code == 0, shown.err
    return dict(json.loads(shown.out))


def _way(run: dict[str, Any]) -> float:
    robot = Recording(Path(run["directory"]) / "run.mcap").trajectories().robot
    assert robot is not None
    return float(robot.x[-1] - robot.x[0])


def test_both_drive_to_the_goal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    port, first = _free_port(), PurePursuit()
    thread = threading.Thread(target=_over_rosbridge, args=(port, first), daemon=True)
    thread.start()
    bridged = _serve(tmp_path, capsys, "bridged", port)
    thread.join(600.0)
    with socket.create_server(("127.0.0.1", 0)) as free:
        endpoint = f"tcp/127.0.0.1:{free.getsockname()[1]}"
    second, made = PurePursuit(), list[_OverZenoh]()
    thread = threading.Thread(target=lambda: made.append(_OverZenoh(endpoint, second)), daemon=True)
    thread.start()
    options = ("--zenoh", endpoint, "--zenoh-router")
    over_zenoh = _serve(tmp_path, capsys, "zenoh", 0, *options)
    thread.join(600.0)
    made[0].session.close()  # type: ignore[no-untyped-call]
    for run, planner in ((bridged, first), (over_zenoh, second)):
        assert planner.seen == set(HEARS)
        assert (run["status"], run["live"]["missed_steps"]) == ("arrived", 0)
        assert _way(run) > 1.0


def _two_robots(folder: Path) -> str:
    """The short way with two robots beside each other, without people."""
    world = YAML(typ="safe").load(Path(SHORT[0]).read_text())
    scenario = world["scenario"]
    del scenario["crowd"]
    one = scenario["robots"].pop("robot")
    for name, y in (("a", 1), ("b", -1)):
        task = {**one["task"], "start": ["1.5 m", f"{y} m", "0 deg"]}
        scenario["robots"][name] = {**one, "task": task}
    file = folder / "two.yaml"
    file.write_text(json.dumps(world))
    return str(file)


def test_two_clients_drive_two_robots_to_the_goal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    port, what = _free_port(), [_two_robots(tmp_path)]
    planners = [PurePursuit(aside=1.0, robot="a"), PurePursuit(aside=-1.0, robot="b")]
    threads = [
        threading.Thread(target=_over_rosbridge, args=(port, planner), daemon=True)
        for planner in planners
    ]
    for thread in threads:
        thread.start()
    run = _serve(tmp_path, capsys, "two", port, what=what)
    for thread in threads:
        thread.join(600.0)
    assert (run["status"], run["live"]["missed_steps"]) == ("arrived", 0)
    for planner in planners:
        assert planner.seen == set(HEARS)
        with Recording(Path(run["directory"]) / "run.mcap") as recording:
            robot = recording.trajectories(planner.robot).robot
        assert robot is not None
        assert robot.x[-1] - robot.x[0] > 1.0


def _constant(port: int, speeds: dict[str, float]) -> None:
    """One client that drives each of its robots with a constant speed."""
    with _connected(port) as client:
        for topic in ("/clock", "/crowdbot/status"):
            _say(client, "subscribe", topic)
        for robot in speeds:
            _say(client, "advertise", f"/{robot}/cmd_vel")
        for frame in client:
            message = json.loads(frame)
            if message.get("topic") == "/clock":
                for robot, v in speeds.items():
                    _say(client, "publish", f"/{robot}/cmd_vel", msg={"linear": {"x": v}})
            elif message["op"] == "publish" and message["msg"]["state"] == "timeout":
                return


def test_robots_driven_from_outside_go_as_those_driven_inside(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    port, speeds = _free_port(), {"a": 0.3, "b": 0.2}
    limits = [x for r in speeds for x in ("--set", f"robots.{r}.task.time_limit=1.5")]
    what = [_two_robots(tmp_path), *limits]
    thread = threading.Thread(target=_constant, args=(port, speeds), daemon=True)
    thread.start()
    outside = _serve(tmp_path, capsys, "two", port, what=what)
    thread.join(600.0)
    file = tmp_path / "constant.py"
    file.write_text(
        "class Constant:\n"
        "    needs = ()\n"
        "    def __init__(self, v=0.0): self.v = v\n"
        "    def reset(self, task, limits, sensors, seed): pass\n"
        "    def step(self, obs): return (self.v, 0.0)\n"
    )
    planner = ["--planner", ",".join(f"{robot}={file}:Constant" for robot in speeds)]
    for robot, v in speeds.items():
        planner += ["--planner-set", f"{robot}.v={v}"]
    argv = [*what, *planner, "--out", str(tmp_path / "inside"), "--no-references", "--json"]
    assert cli.main(["simulate", *argv]) == 0
    inside = json.loads(capsys.readouterr().out)
    assert outside["hashes"] == inside["hashes"]
    assert (outside["live"]["steps"], outside["live"]["missed_steps"]) == (24, 0)
