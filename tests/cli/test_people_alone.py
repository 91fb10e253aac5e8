"""A scenario without a robot runs: its people walk alone, are recorded, shown and reported."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot import cli
from tests.paths import ROOT

LANES = ROOT / "docs" / "howto" / "files" / "streams_lanes.yaml"


@pytest.mark.slow
def test_people_walk_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    argv = ["simulate", str(LANES), "--out", str(tmp_path), "--duration", "2"]
    assert cli.main([*argv, "--json"]) == 0
    run = json.loads(capsys.readouterr().out)
    assert (run["planner"]["label"], run["sim_time"], run["duration"]) == ("no_robot", 2.0, 2.0)
    folder = Path(run["directory"])
    assert {"run.mcap", "replay.html", "scores.csv", "scenario.yaml"} <= {
        p.name for p in folder.iterdir()
    }
    people = crowdbot.Run.open(folder).trajectories
    assert people.robot is None
    assert people.agents is not None
    moved = np.hypot(people.agents.x[-1] - people.agents.x[0], people.agents.y[-1])
    assert np.nanmax(moved) > 1.0

    assert cli.main(argv) == 0  # the same run again
    assert "people walked alone for 2.0 s; was complete already" in capsys.readouterr().out
    assert cli.main(["simulate", str(LANES), "--out", str(tmp_path), "--duration", "1"]) == 0
    assert "alone for 1.0 s" in capsys.readouterr().out, "another duration is another run"
    assert cli.main(["view", str(folder), "--out", str(tmp_path / "v.html")]) == 0
    capsys.readouterr()
    assert cli.main(["report", str(tmp_path), "--out", str(tmp_path / "r.html"), "--json"]) == 0
    counted = json.loads(capsys.readouterr().out)["runs"]
    assert (counted["people_alone"], counted["timeout"]) == (1, 0)  # nothing ran out of time
    assert cli.main(["export", str(folder), "--to", "csv", "--out", str(tmp_path / "t")]) == 0
    assert (tmp_path / "t" / "people.csv").stat().st_size > 1000


def test_what_needs_a_robot_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path)]
    assert cli.main(["simulate", str(LANES), "--planner", "dwa", *out]) == 2
    assert "--planner dwa: lanes has no robot to drive" in capsys.readouterr().err
    id_ = "in-d0125-slow-c01-r02"
    assert cli.main(["simulate", "challenge-2020", id_, "--duration", "4", *out]) == 1
    assert "has a robot, whose task ends the run" in capsys.readouterr().err
    assert cli.main(["simulate", str(LANES), "--duration", "-1", *out]) == 1
    assert "duration -1 s must be above 0" in capsys.readouterr().err
    shutil.copy(LANES.parent / "streams_base.yaml", tmp_path)
    (tmp_path / "empty.yaml").write_text(
        "crowdbot: 1\nscenario:\n  id: empty\n  environment: {kind: floor, area: "
        "{x: [0 m, 9 m], y: [0 m, 9 m]}, zones: {all: {x: [0 m, 9 m], y: [0 m, 9 m]}}}\n"
    )
    assert cli.main(["simulate", str(tmp_path / "empty.yaml"), *out]) == 1
    assert "'empty' has neither a robot nor people" in capsys.readouterr().err
