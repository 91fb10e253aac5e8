from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot.cli import main

Captured = pytest.CaptureFixture[str]
ONE = "counter-d0500-fast-c20-r05"


def test_list(capsys: Captured) -> None:
    assert main(["expand", "challenge-2020"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 162
    assert all(len(line.split()) == 2 and "  cb1-sha256:" in line for line in lines)


def test_only_and_count(capsys: Captured) -> None:
    assert main(["expand", "challenge-2020", "--only", "counter-*-c50-*", "--count"]) == 0
    assert capsys.readouterr().out == "27\n"
    assert main(["expand", "challenge-2020", "--only", "sideways-*"]) == 1


@pytest.mark.slow
def test_json(capsys: Captured) -> None:
    assert main(["expand", "challenge-2020", "--only", ONE, "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["suite"], row["id"]) == ("challenge-2020", ONE)


def test_one_reads_back_to_the_same_hash(tmp_path: Path, capsys: Captured) -> None:
    main(["expand", "challenge-2020", "--only", ONE])
    listed = capsys.readouterr().out
    assert main(["expand", "challenge-2020", "--one", f"challenge-2020/{ONE}"]) == 0
    file = tmp_path / "one.yaml"
    file.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["expand", str(file)]) == 0
    assert capsys.readouterr().out == listed


def test_one_as_json(capsys: Captured) -> None:
    assert main(["expand", "challenge-2020", "--one", ONE, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["hash"].startswith("cb1-sha256:")
    assert content["scenario"]["crowd"]["flow"]["density"] == 0.5


def test_explain(capsys: Captured) -> None:
    argv = ["expand", "challenge-2020", "--one", ONE, "--explain", "--set", "crowd.body.mass=80"]
    assert main(argv) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    places = {line[0]: line[-1] for line in lines if "#" in line}
    assert places["density:"].endswith("challenge-2020.yaml:46")
    assert places["length:"].endswith("parts/corridor_50x10.yaml:5")
    assert "--set:1" in [line[-1] for line in lines if line[0] == "mass:"]
    assert places["wall_height:"] == "default"
    assert main(["expand", "challenge-2020", "--explain"]) == 2


@pytest.mark.slow
def test_set(capsys: Captured) -> None:
    argv = ["expand", "challenge-2020", "--only", ONE, "--set"]
    assert main([*argv, "crowd.speed.mean=1 m/s"]) == 0
    assert capsys.readouterr().out.startswith(f"{ONE}+")
    assert main([*argv, "crowd.sped.mean=1"]) == 1
    assert "did you mean 'speed'?" in capsys.readouterr().err
    assert main([*argv, "nonsense"]) == 2
    assert "write key=value" in capsys.readouterr().err
