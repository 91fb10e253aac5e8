"""The wheelchair that its driver steers, from the command line to the scores of shared control."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from crowdbot import cli
from tests.paths import ROOT

FILES = ROOT / "docs" / "howto" / "files"


@pytest.mark.slow
def test_the_wheelchair_of_the_guide_is_driven_and_scored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two seconds: the chair does what its driver asks for or brakes; scores know both commands."""
    for name in ("wheelchair.yaml", "share_control.py"):
        shutil.copy(FILES / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    argv = ["simulate", "wheelchair.yaml", "--planner", "share_control.py:ShareControl",
            "--no-references", "--set", "robots.robot.task.time_limit=2",
            "--quiet", "--json"]  # fmt: skip
    assert cli.main(argv) == 0
    run = json.loads(capsys.readouterr().out)
    assert (run["status"], run["sim_time"]) == ("timeout", 2.0)

    asked, values_text = (_velocities(Path(run["directory"]), topic) for topic in
                   ("/joystick/cmd_vel", "/cmd_vel"))  # fmt: skip
    assert len(asked) == len(values_text) == 2 * 16
    assert np.ptp(asked[:, 0]) > 0.01  # the hand is not steady
    assert asked[:, 0].max() <= 1.5
    assert asked[:, 0].mean() > 1.0  # the goal is straight ahead
    assert values_text[:, 1] == pytest.approx(asked[:, 1], abs=1e-9)  # the planner only brakes
    assert np.all(values_text[:, 0] <= asked[:, 0] + 1e-9)
    assert values_text[:, 0].mean() > 0.5

    text = (Path(run["directory"]) / "scores.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(text.splitlines())
    written = {row["metric"]: row for row in rows if row["variant"] == "corrected"}
    assert 0.9 < float(written["agreement"]["value"]) < 1.0
    assert 0.0 < float(written["fluency"]["value"]) < 1.0
    assert written["user_input_entropy"]["reason"] == "no_baseline"

    argv = ["evaluate", run["directory"], "--commands-baseline", run["directory"]]
    for topics in ([], ["--user-topic", "/joystick/cmd_vel"]):  # found, or named
        assert cli.main([*argv, *topics, "--json"]) == 0
        (scored,) = json.loads(capsys.readouterr().out)
        values = {s["metric"]: s["value"] for s in scored["scores"] if s["variant"] == "corrected"}
        assert values["agreement"] == pytest.approx(float(written["agreement"]["value"]), abs=1e-3)
        assert values["fluency"] == pytest.approx(float(written["fluency"]["value"]), abs=1e-3)
        assert 0.0 < values["user_input_entropy"] < 1.0


def _velocities(run: Path, topic: str) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """(N, 2) m/s ahead and rad/s, as a reader that is not ours reads them."""
    with AnyReader([run / "run.mcap"]) as reader:
        (connection,) = [c for c in reader.connections if c.topic == topic]
        messages = [reader.deserialize(raw, connection.msgtype)
                    for _, _, raw in reader.messages([connection])]  # fmt: skip
    twists: list[Any] = [getattr(m, "twist", m) for m in messages]
    return np.array([(twist.linear.x, twist.angular.z) for twist in twists])
