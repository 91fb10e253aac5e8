"""The programs for users of ROS: clock, keyboard and joystick, launch files."""

from __future__ import annotations

import ast
import importlib.util
import json
import shutil
import sys
import threading
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree.ElementTree import fromstring  # of what crowdbot prints

import pytest
import yaml

from crowdbot.cli import main
from crowdbot.core.recording.topics import Topic
from tests.paths import ROOT

FOLDER = ROOT / "docs" / "examples" / "ros"


def _module(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"example_{name}", FOLDER / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_clock_moves_on_until_the_server_ends() -> None:
    from websockets.sync.server import serve

    got: list[dict[str, Any]] = []

    def take(connection: Any) -> None:
        got.extend(json.loads(connection.recv()) for _ in range(4))

    with serve(take, "127.0.0.1", 0) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        port = server.socket.getsockname()[1]
        module = _module("clock_publisher")
        assert module.publish(0.0, 0.05, f"ws://127.0.0.1:{port}") >= 3
        server.shutdown()
        thread.join()
    assert got[0] == {"op": "advertise", "topic": "/clock", "type": "rosgraph_msgs/Clock"}
    assert [m["msg"]["clock"]["nanosec"] for m in got[1:]] == [0, 50_000_000, 100_000_000]
    assert module.clock(30, 0.1)["msg"] == {"clock": {"sec": 3, "nanosec": 0}}


def test_keys() -> None:
    drive = _module("drive")
    stick = drive.Stick()
    for key in "wwwwwwwwwwwwa":
        stick = drive.after_key(stick, key)
    assert stick == pytest.approx((1.0, 0.1))
    assert drive.after_key(stick, "x") == stick
    assert drive.after_key(stick, " ") == (0.0, 0.0)
    assert drive.after_key(stick, "q") is None
    message = json.loads(drive.twist(stick, 0.5, 2.0))["msg"]
    assert (message["linear"]["x"], message["angular"]["z"]) == pytest.approx((0.5, 0.2))


def test_a_joystick() -> None:
    drive = _module("drive")
    stick = drive.after_event(drive.Stick(), drive.EVENT.pack(7, -32767, 0x82, 1))
    assert stick == (1.0, 0.0)  # pushed ahead
    stick = drive.after_event(stick, drive.EVENT.pack(8, 32767, 2, 0))
    assert stick == (1.0, -1.0)  # and to the right
    assert drive.after_event(stick, drive.EVENT.pack(9, 1, 1, 0)) == stick  # a button


class _Made:
    """What a launch file made: an action, a substitution or a value."""

    def __init__(self, *given: Any, **fields: Any) -> None:
        self.given, self.fields = given, fields


@pytest.fixture
def _launch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Stand-ins for the packages of ROS 2 that launch files import."""
    names = {
        "launch": ("LaunchDescription",),
        "launch.actions": ("DeclareLaunchArgument", "ExecuteProcess"),
        "launch.substitutions": ("Command", "LaunchConfiguration"),
        "launch_ros": (),
        "launch_ros.actions": ("Node",),
        "launch_ros.parameter_descriptions": ("ParameterValue",),
    }
    for module, classes in names.items():
        stand_in = ModuleType(module)
        for name in classes:
            setattr(stand_in, name, type(name, (_Made,), {}))
        monkeypatch.setitem(sys.modules, module, stand_in)


def _words(parts: list[Any], given: dict[str, str]) -> list[str]:
    """Return the words of a command in which arguments have values."""
    text = "".join(p if isinstance(p, str) else given[p.given[0]] for p in parts)
    return text.split()


@pytest.mark.usefixtures("_launch")
@pytest.mark.parametrize("file", ["crowdbot", "replay"])
def test_rviz_gets_the_model_of_the_robot(
    file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The command that a launch file runs for robot_state_publisher prints the robot's URDF."""
    module = _module(f"{file}.launch")
    (actions,) = module.generate_launch_description().given
    nodes = {a.fields["package"]: a.fields for a in actions if "package" in a.fields}
    declared = {a.given[0]: a.fields.get("default_value") for a in actions if a.given}
    if file == "replay":
        declared["bag"] = str(tmp_path)
        shutil.copy(ROOT / "docs/howto/files/my_urdf.yaml", tmp_path / "scenario.yaml")
        shutil.copytree(ROOT / "docs/howto/files/my_robots", tmp_path / "my_robots")
    (description,) = (p["robot_description"] for p in nodes["robot_state_publisher"]["parameters"])
    crowdbot, *words = _words(description.given[0].given[0], declared)
    assert crowdbot == "crowdbot"
    assert main(words) == 0
    robot = fromstring(capsys.readouterr().out)
    assert "base_footprint" in {link.get("name") for link in robot}
    ((_, config),) = [nodes["rviz2"]["arguments"]]
    assert Path(config) == FOLDER / "crowdbot.rviz"


def test_rviz_shows_topics_that_there_are() -> None:
    config = yaml.safe_load((FOLDER / "crowdbot.rviz").read_text(encoding="utf-8"))
    displays = config["Visualization Manager"]["Displays"]
    shown = {d.get("Topic", d.get("Description Topic", {})).get("Value") for d in displays}
    assert shown - {None} <= {*Topic, "/scan", "/odom"}
    assert Topic.DESCRIPTION in shown


@pytest.mark.parametrize("file", ["crowdbot", "replay"])
def test_a_launch_file_names_what_crowdbot_has(file: str) -> None:
    tree = ast.parse((FOLDER / f"{file}.launch.py").read_text(encoding="utf-8"))
    words = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    from crowdbot.cli.app.typer_app import load

    options = {text for param in load("serve").params for text in param.opts} | {"--remap"}
    assert {w for w in words if isinstance(w, str) and w.startswith("--")} <= options
