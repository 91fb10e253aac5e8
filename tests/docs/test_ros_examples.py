"""The programs for users of ROS: clock, keyboard and joystick, launch file."""

from __future__ import annotations

import ast
import importlib.util
import json
import threading
from types import ModuleType
from typing import Any

import pytest

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


def test_the_launch_file_names_what_crowdbot_has() -> None:
    tree = ast.parse((FOLDER / "crowdbot.launch.py").read_text(encoding="utf-8"))
    words = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    from crowdbot.cli.app.typer_app import load

    options = {text for param in load("serve").params for text in param.opts}
    assert {w for w in words if isinstance(w, str) and w.startswith("--")} <= options
