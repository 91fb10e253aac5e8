"""A person drives: the run is an ordinary one, and holds what the hand did, sample by sample."""

from __future__ import annotations

import json
import secrets
import socket
import threading
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from crowdbot import cli
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.recording import Recording
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.types.robot import RobotLimits
from tests.core.live.person.page_cases import say
from tests.paths import DATA

SHORT = [str(DATA / "short_way.yaml"), "--set", "robots.robot.task.time_limit=1"]
#: From this time on the hand is here: ahead, left.
HAND = {0.2: (0.5, 0.0), 0.5: (1.0, -0.25), 0.8: (-1.0, 1.0)}
_TWIST = "geometry_msgs/msg/TwistStamped"


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


def _page(port: int) -> ClientConnection:
    while True:
        try:
            return connect(f"ws://127.0.0.1:{port}/socket?token=token", compression=None)
        except ConnectionRefusedError:
            threading.Event().wait(0.02)


class Hand(threading.Thread):
    """A page that moves its stick by the clock of the run, and notes which step used what."""

    def __init__(self, port: int) -> None:
        super().__init__(daemon=True)
        self.port, self.used, self.end = port, dict[float, int](), dict[str, Any]()
        self.scene: dict[str, Any] = {}
        self.frames: list[dict[str, Any]] = []

    def run(self) -> None:
        with _page(self.port) as page:
            say(page, "here", away="")
            try:
                for frame in page:
                    self._hear(page, json.loads(frame))
            except ConnectionClosed:
                pass

    def _hear(self, page: ClientConnection, message: dict[str, Any]) -> None:
        match message["op"]:
            case "scene":
                self.scene = message["scene"]
            case "state" if message["waits"] == "not begun":
                say(page, "begin")
            case "frame":
                self.frames.append(message)
                say(page, "here", away="")
                for n, (since, (ahead, left)) in enumerate(HAND.items(), 1):
                    if message["t"] >= since and n > max(self.used.values(), default=0):
                        say(page, "stick", n=n, ahead=ahead, left=left)
                        break
            case "taken":
                self.used[message["t"]] = message["n"]
            case "end":
                self.end = message


def _commands(run: Path, topic: str) -> dict[float, tuple[float, float]]:
    found = {}
    for record in Records(run / "run.mcap"):
        if record.topic == topic:
            message = ros.from_cdr(record.data, record.msgtype)
            twist = message.twist if record.msgtype == _TWIST else message
            found[record.ns / 1e9] = (twist.linear.x, twist.angular.z)
    return found


def test_the_recording_holds_what_the_hand_did_and_repeats_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(secrets, "token_urlsafe", lambda _: "token")
    hand = Hand(_free_port())
    hand.start()
    argv = ["teleop", *SHORT, "--out", str(tmp_path), "--no-references", "--json"]
    assert cli.main([*argv, "--port", str(hand.port), "--rate", "2"]) == 0
    hand.join(20.0)
    shown = json.loads(capsys.readouterr().out)
    run = Path(shown["directory"])
    assert (hand.end["status"], hand.end["directory"]) == (shown["status"], str(run))

    user, final = _commands(run, "/joystick/cmd_vel"), _commands(run, "/cmd_vel")
    assert len(user) == shown["live"]["steps"] == 16
    assert sorted(hand.used.values()) == [1, 2, 3]
    limits = _limits(run)
    for t, command in user.items():
        n = max((n for since, n in hand.used.items() if since <= t), default=0)
        ahead, left = list(HAND.values())[n - 1] if n else (0.0, 0.0)
        v = ahead * limits.v_max if ahead > 0.0 else -ahead * limits.v_min
        assert command == pytest.approx((v, left * limits.w_max))
    assert final == user

    scores = {(s["metric"], s["variant"]): s["value"] for s in shown["scores"]}
    assert scores["agreement", "corrected"] == pytest.approx(1.0)
    assert hand.scene["robots"][0]["name"] == "robot"
    assert len(hand.scene["solids"]["robots"][0]["parts"]) > 0
    assert len(hand.frames[-1]["people"][0]) == hand.scene["people"]["count"] > 0
    assert (run / "replay.html").is_file()
    assert RunRecord.read(run).live is not None

    assert cli.main([*argv, "--replay", str(run), "--name", "again"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["hashes"] == shown["hashes"]
    assert _commands(Path(again["directory"]), "/joystick/cmd_vel") == user


def _limits(run: Path) -> RobotLimits:
    with Recording(run / "run.mcap") as recording:
        robot = recording.robot(None).header.robot
    assert robot is not None
    assert robot.limits is not None
    return robot.limits


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (["--robot", "x"], "has no robot 'x', but robot"),
        (["--planner", "dwa"], "reads no joystick"),
        (["--planner", "robot=dwa"], "has a person at its stick"),
        (["--name", "../x"], "cannot be the name"),
        (["--replay", str(DATA / "recordings" / "format_3.mcap")], "no commands of a person"),
        (["--rate", "nan"], "--rate"),
    ],
)
def test_what_cannot_be_driven_is_said(
    more: list[str], expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["teleop", *SHORT, "--out", str(tmp_path), *more]) != 0
    assert expected in capsys.readouterr().err
    assert not any(tmp_path.iterdir())
