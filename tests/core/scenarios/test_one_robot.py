"""What drives one robot says which there are, and what drives several."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.cli import main
from crowdbot.core.registry.registry import discover
from tests.core.sim.fleets import robot, scenario


def test_serve_refuses_several_robots_before_anybody_connects(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    two = {"a": robot(0.0, 0.0, 0.0, "east"), "b": robot(1.0, 0.0, 0.0, "west")}
    scenario(tmp_path, discover(), two)
    assert main(["serve", str(tmp_path / "hall.yaml")]) == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "hall has 2 robots, a, b" in said
    assert "waiting" not in said
