from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from crowdbot.cli import main
from crowdbot.core.registry import Plugin, Registry, assemble, discover

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> None:
    plugin = Plugin(name="bad", distribution="crowdbot-x 0.1", error="ImportError: no\n'torch'")
    registry = assemble([*discover(allow=()).plugins, plugin])
    found: Callable[..., Registry] = lambda **_: registry  # noqa: E731 - a stand-in
    monkeypatch.setattr("crowdbot.core.registry.discover", found)


@pytest.mark.usefixtures("broken")
def test_list_never_fails(capsys: Captured) -> None:
    assert main(["plugins"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["plugin", "distribution", "api", "state", "provides"]
    assert "robot: turtlebot2" in lines[1]
    assert lines[2].split(maxsplit=5)[-2:] == ["failed", "ImportError: no 'torch'"]


@pytest.mark.usefixtures("broken")
def test_json(capsys: Captured) -> None:
    assert main(["plugins", "--json"]) == 0
    builtin, bad = json.loads(capsys.readouterr().out)
    assert builtin["provides"]["environment"] == ["corridor", "floor"]
    assert (bad["state"], bad["provides"]) == ("failed", {})


def test_show(capsys: Captured) -> None:
    assert main(["plugins", "show", "lidar2d"]) == 0
    shown = capsys.readouterr().out
    assert "planar laser scanner" in shown
    assert "crowdbot.plugins.sensors.lidar2d_build:build" in shown
    assert "kind: lidar2d" in shown
    rows = {line.split()[0]: line.split() for line in shown.splitlines() if line.strip()}
    assert rows["rate"][:4] == ["rate", "number", "Hz", "16"]
    assert rows["mount.yaw"][2] == "rad"


def test_show_every_kind(capsys: Captured) -> None:
    registry = discover(allow=())
    for plugin in registry.plugins:
        for component in plugin.components:
            assert main(["plugins", "show", component.kind]) == 0, component.kind
            assert main(["plugins", "show", component.kind, "--json"]) == 0
    assert "Traceback" not in capsys.readouterr().err


def test_show_json(capsys: Captured) -> None:
    assert main(["plugins", "show", "ttca_dca", "--json"]) == 0
    (about,) = json.loads(capsys.readouterr().out)
    assert about["category"] == "cost function"
    fields = {f["field"]: f for f in about["fields"]}
    assert fields["sigma_ttca"]["unit"] == "s"
    assert fields["range.measure"]["default"] == "centre"


def test_show_unknown(capsys: Captured) -> None:
    assert main(["plugins", "show", "lidar2"]) == 1
    assert "did you mean 'lidar2d'" in capsys.readouterr().err
