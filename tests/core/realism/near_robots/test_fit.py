"""``crowdbot calibrate --robot`` and ``realism --robot``: fits, parts, errors."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.core.realism.near_robots.calibrate import RobotFitTask
from crowdbot.errors import InputError
from tests.core.realism.near_robots.walks import as_table, various


@pytest.fixture
def recordings(tmp_path: Path) -> list[str]:
    paths = as_table(tmp_path, various(8, aside=0.9))
    return [word for p in paths for word in ("--reference", str(p))]


def test_a_fit_is_written_as_a_part_that_realism_reads(
    tmp_path: Path, recordings: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "mine.yaml"
    words = ["calibrate", "giving_way", "--robot", "--fit", "clearance=0.1..0.8", "--out", str(out)]
    assert cli.main([*words, "--generations", "1", "--population", "4", "--json", *recordings]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert 0.1 < facts["parameters"]["crowd.robot_response.clearance"]["value"] < 0.8
    assert "kind: giving_way" in out.read_text(encoding="utf-8")
    assert cli.main(["realism", "--robot", str(out), "--json", *recordings]) == 0
    assert json.loads(capsys.readouterr().out)[0]["cells"]["front/walking"]["recorded"] == 8


def test_too_few_meetings_are_an_error_before_anything_is_simulated(tmp_path: Path) -> None:
    (path,) = as_table(tmp_path, various(1))
    with pytest.raises(InputError, match="1 meetings"):
        _ = RobotFitTask(crowd="giving_way", files=(str(path),)).ceiling


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["realism", "--robot", "giving_wya"], "giving_wya"),
        (["realism", "--robot", "giving_way", "--set", "robot_response.clearanec=1"], "clearance"),
        (["calibrate", "giving_way", "--robot", "--fit", "clearanec=0..1"], "clearance"),
    ],
)
def test_wrong_names_are_told_with_the_nearest(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(words) == 1
    assert message in capsys.readouterr().err
