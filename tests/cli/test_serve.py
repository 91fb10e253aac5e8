"""`crowdbot serve`: programs outside drive, and the run is an ordinary one."""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from crowdbot import cli
from tests.cli.simulate_cases import FILES, ID, limit
from tests.paths import ROOT

pytestmark = pytest.mark.slow
TWIST = {"linear": {"x": 0.4}, "angular": {"z": 0.1}}
Act = Callable[[ClientConnection], None]
#: A robot of the challenge needs more than a minute to its goal; here 3 s do.
SHORT = [str(ROOT / "tests/data/short_way.yaml")]


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


@contextmanager
def _connected(port: int) -> Iterator[ClientConnection]:
    """A client, as soon as somebody listens."""
    end = time.monotonic() + 600.0
    while True:
        try:
            with connect(f"ws://127.0.0.1:{port}", compression=None, close_timeout=0.5) as found:
                yield found
            return
        except ConnectionRefusedError:
            assert time.monotonic() < end
            time.sleep(0.02)


def _say(client: ClientConnection, op: str, topic: str, **fields: Any) -> None:
    client.send(json.dumps({"op": op, "topic": topic, **fields}))


def _steps(client: ClientConnection) -> Iterator[dict[str, Any]]:
    """Messages of /clock, until the run ends."""
    _say(client, "subscribe", "/crowdbot/status")
    _say(client, "subscribe", "/clock")
    _say(client, "advertise", "/cmd_vel")
    for frame in client:
        message = json.loads(frame)
        if message.get("topic") == "/clock":
            yield message["msg"]
        elif message.get("topic") == "/crowdbot/status" and message["msg"]["state"] == "timeout":
            return


def _drive(client: ClientConnection) -> None:
    for _ in _steps(client):
        _say(client, "publish", "/cmd_vel", msg=TWIST)


class Served:
    """Calls the command, with a client in a thread beside it."""

    def __init__(self, out: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.out, self._capsys, self.err = out, capsys, ""

    def __call__(self, *more: str, act: Act = _drive, seconds: float = 1.0) -> dict[str, Any]:
        port, failed = _free_port(), list[Exception]()

        def client() -> None:
            try:
                with _connected(port) as connection:
                    act(connection)
            except Exception as error:
                failed.append(error)

        thread = threading.Thread(target=client, daemon=True)
        thread.start()
        argv = ["challenge-2020", ID, *limit(seconds), "--out", str(self.out), "--record", "none"]
        code = cli.main(["serve", *argv, "--port", str(port), "--json", *more])
        thread.join(600.0)
        shown = self._capsys.readouterr()
        self.err = shown.err
        assert code == 0, shown.err
        assert not failed, failed
        return dict(json.loads(shown.out))


@pytest.fixture
def served(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Served:
    return Served(tmp_path, capsys)


def _timed(seconds: float) -> list[str]:
    return ["challenge-2020", ID, *limit(seconds)]


def _inside(out: Path, capsys: pytest.CaptureFixture[str], planner: str, what: list[str]) -> Any:
    argv = [*what, "--out", str(out / "inside"), "--record", "none"]
    assert cli.main(["simulate", *argv, "--planner", planner, "--no-references", "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@contextmanager
def _server(out: Path, what: list[str]) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """The command in a process of its own, as soon as it listens."""
    port = _free_port()
    argv = [*what, "--out", str(out), "--record", "none"]
    code = "import sys; from crowdbot.cli import main; sys.exit(main())"
    with subprocess.Popen(
        [sys.executable, "-c", code, "serve", *argv, "--port", str(port), "--json"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT,
    ) as server:  # fmt: skip
        assert server.stderr is not None
        while "rosbridge:" not in (line := server.stderr.readline()):
            assert line
        yield server, port


def _driven(out: Path, driver: Callable[[int], list[str]]) -> Any:
    """The record of a run that a client in another process drove to the goal."""
    with _server(out, SHORT) as (server, port):
        done = subprocess.run(driver(port), cwd=ROOT, timeout=600, check=False)
        assert done.returncode == 0
        text, _ = server.communicate(timeout=600)
    return json.loads(text)


def _same(outside: Any, inside: Any) -> None:
    """The same run, up to the goal, without a missed step."""
    assert outside["hashes"] == inside["hashes"]
    assert outside["status"] == inside["status"] == "arrived"
    live = outside["live"]
    assert live == {"steps": live["steps"], "missed_steps": 0, "refused_commands": 0}
    assert live["steps"] > 40


@pytest.mark.parametrize("kind", ["Twist", "TwistStamped"])
def test_roslibpy_drives_to_the_goal_as_the_same_planner_inside(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    module = "tests.core.live.roslibpy_driver"
    outside = _driven(tmp_path, lambda port: [sys.executable, "-m", module, str(port), kind])
    planner = f"{ROOT / 'tests/core/live/pursuit.py'}:Pursuit"
    _same(outside, _inside(tmp_path, capsys, planner, SHORT))
    assert {p.name for p in Path(outside["directory"]).iterdir()} == FILES
    assert (outside["planner"]["label"], outside["pinned"]) == ("live", False)


def test_roslib_drives_to_the_goal_as_the_same_planner_inside(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where node is, and roslib: ``npm install roslib``, CROWDBOT_NODE_MODULES says where."""
    node, folder = shutil.which("node"), os.environ.get("CROWDBOT_NODE_MODULES", "")
    if node is None or not (Path(folder) / "roslib").is_dir():
        pytest.skip("needs node, and roslib in the folder that CROWDBOT_NODE_MODULES names")
    driver = str(ROOT / "tests/core/live/roslib_driver.mjs")
    outside = _driven(tmp_path, lambda port: [node, driver, folder, str(port)])
    planner = f"{ROOT / 'tests/core/live/pursuit.py'}:Straight"
    _same(outside, _inside(tmp_path, capsys, planner, SHORT))


def test_the_next_scenario_begins(tmp_path: Path) -> None:
    """A client ends a run and begins the next one of the suite."""
    seen: list[str] = []
    with _server(tmp_path, _timed(0.5)) as (server, port), _connected(port) as client:
        for name in ("/crowdbot/status", "/clock"):
            _say(client, "subscribe", name)
        _say(client, "advertise", "/cmd_vel")
        with suppress(ConnectionClosed):  # when the second run is over
            for frame in client:
                message = json.loads(frame)
                if message.get("topic") == "/crowdbot/status":
                    seen.append(message["msg"]["scenario"])
                elif message.get("topic") == "/clock":
                    if len(set(seen)) == 1:
                        _call(client, "/crowdbot/next_scenario", {})
                    _say(client, "publish", "/cmd_vel", msg=TWIST)
        text, _ = server.communicate(timeout=600)
    record = json.loads(text)
    first, second = dict.fromkeys(seen)
    assert first.startswith(ID.split("+")[0])
    assert record["scenario"] == second
    (partial,) = tmp_path.glob("*/*/live/*.partial")
    assert partial.parent.parent.name == first.replace("+", "+time_limit=0.5_s-")


def test_who_disturbs_changes_nothing(served: Served) -> None:
    quiet = served("--name", "quiet")

    def disturbed(client: ClientConnection) -> None:
        port = client.remote_address[1]
        for k, _ in enumerate(_steps(client)):
            with _connected(port) as other:
                _say(other, "publish", "/cmd_vel", msg={"linear": {"x": -0.3}})
                other.send("[" * 1000)
                other.send(b"\x9b\xff")
                if k % 2:
                    other.socket.shutdown(socket.SHUT_RDWR)
            _say(client, "publish", "/cmd_vel", msg=TWIST)

    loud = served("--name", "loud", act=disturbed)
    assert loud["hashes"] == quiet["hashes"]


def test_a_step_without_a_command_has_a_defined_answer(
    served: Served, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def once(client: ClientConnection) -> None:
        for k, _ in enumerate(_steps(client)):
            if k == 0:
                _say(client, "publish", "/cmd_vel", msg=TWIST)

    # so long that the one answer comes in time on any machine
    options = ("--budget", "3", "--missed", "hold", "--name", "held")
    held = served(*options, act=once, seconds=0.25)
    assert held["live"]["missed_steps"] == held["live"]["steps"] - 1
    file = tmp_path / "constant.py"
    file.write_text(
        "class Constant:\n"
        "    needs = ()\n"
        "    def reset(self, task, limits, sensors, seed): pass\n"
        "    def step(self, obs): return (0.4, 0.1)\n"
    )
    assert held["hashes"] == _inside(tmp_path, capsys, f"{file}:Constant", _timed(0.25))["hashes"]
    stopped = served("--budget", "0.02", "--name", "stopped", act=once, seconds=0.25)
    assert stopped["hashes"]["trajectory"] != held["hashes"]["trajectory"]


def test_a_driver_may_leave_and_come_back(served: Served) -> None:
    def leave(client: ClientConnection) -> None:
        port = client.remote_address[1]
        for k, _ in enumerate(_steps(client)):
            if k == 3:
                break
            _say(client, "publish", "/cmd_vel", msg=TWIST)
        client.socket.shutdown(socket.SHUT_RDWR)
        with _connected(port) as again:
            _drive(again)

    run = served(act=leave, seconds=2.0)
    assert run["status"] == "timeout"
    assert run["live"]["steps"] == 32


def test_real_time_counts_what_is_missed_and_late(served: Served) -> None:
    def slow(client: ClientConnection) -> None:
        for k, _ in enumerate(_steps(client)):
            if k % 4 == 0:
                _say(client, "publish", "/cmd_vel", msg=TWIST)

    run = served("--rate", "4", act=slow, seconds=2.0)
    assert run["wall_time"] >= 2.0 / 4 - 0.1
    assert 10 <= run["live"]["missed_steps"] <= 32
    assert run["live"]["largest_lag"] >= 0.0


def test_an_external_clock_steps_once_for_each_time(
    served: Served, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Missed, doubled and backward times neither lose nor repeat a step."""

    def tick(client: ClientConnection) -> None:
        _say(client, "subscribe", "/crowdbot/status")
        _say(client, "advertise", "/cmd_vel")
        _say(client, "publish", "/cmd_vel", msg=TWIST)
        times = [0.0, 0.05, 0.05, 0.02, 0.3, 0.1, 0.3, 0.31, 0.32, 0.9, 0.1, 1.0]
        for t in times:
            clock = {"sec": int(t), "nanosec": round((t % 1) * 1e9)}
            _say(client, "publish", "/clock", msg={"clock": clock})
        for frame in client:
            message = json.loads(frame)
            if message["op"] == "publish" and message["msg"]["state"] == "timeout":
                return

    run = served("--clock", "external", "--hold", "9", act=tick)
    assert run["live"]["steps"] == 16
    file = tmp_path / "constant.py"
    file.write_text(
        "class Constant:\n"
        "    needs = ()\n"
        "    def reset(self, task, limits, sensors, seed): pass\n"
        "    def step(self, obs): return (0.4, 0.1)\n"
    )
    assert run["hashes"] == _inside(tmp_path, capsys, f"{file}:Constant", _timed(1.0))["hashes"]


def test_another_seed_begins_the_run_again(served: Served) -> None:
    def again(client: ClientConnection) -> None:
        for k, _ in enumerate(_steps(client)):
            if k == 3:
                _call(client, "/crowdbot/set_seed", {"seed": 5})
            _say(client, "publish", "/cmd_vel", msg=TWIST)

    run = served(act=again)
    assert run["seed"] == 5
    assert run["live"]["steps"] == 16
    assert run["directory"].endswith("seed-5")


def _call(client: ClientConnection, service: str, args: dict[str, Any]) -> None:
    client.send(json.dumps({"op": "call_service", "service": service, "args": args}))


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--rate", "0"], 2, "--rate must be above 0"),
        (["--budget", "nan"], 2, "--budget must be above 0"),
        (["--rate", "1", "--clock", "external"], 2, "exclude each other"),
        (["--name", "a/b"], 1, "cannot be the name"),
        (["--set", "robots={}"], 1, "has no robot"),
        (["--host", "203.0.113.1"], 1, "cannot listen there"),
    ],
)
def test_what_is_wrong_is_told(
    capsys: pytest.CaptureFixture[str], options: list[str], code: int, message: str, tmp_path: Path
) -> None:
    argv = ["serve", "challenge-2020", ID, "--port", "0", "--out", str(tmp_path), *options]
    assert cli.main(argv) == code
    assert message in capsys.readouterr().err
