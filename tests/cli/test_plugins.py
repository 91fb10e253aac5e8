from __future__ import annotations

import json
from collections.abc import Callable
from importlib import metadata

import pytest

from crowdbot.cli import main
from crowdbot.core.registry.registry import Plugin, Registry, assemble, discover
from tests.paths import ROOT

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> None:
    plugin = Plugin(name="bad", distribution="crowdbot-x 0.1", error="ImportError: no\n'torch'")
    registry = assemble([*discover(allow=()).plugins, plugin])
    found: Callable[..., Registry] = lambda **_: registry  # noqa: E731 - a stand-in
    monkeypatch.setattr("crowdbot.core.registry.registry.discover", found)


@pytest.mark.usefixtures("broken")
def test_list_never_fails(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "400")
    assert main(["plugins"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["plugin", "distribution", "api", "state", "provides"]
    assert "robot: 7 " in lines[1]
    assert "noise: gaussian offset peak " in lines[1]
    assert lines[2].split(maxsplit=5)[-2:] == ["failed", "ImportError: no 'torch'"]


@pytest.mark.usefixtures("broken")
def test_json(capsys: Captured) -> None:
    assert main(["plugins", "--json"]) == 0
    builtin, bad = json.loads(capsys.readouterr().out)
    assert {"corridor", "floor", "street"} <= set(builtin["provides"]["environment"])
    assert (bad["state"], bad["provides"]) == ("failed", {})


def test_show(capsys: Captured) -> None:
    assert main(["plugins", "show", "lidar2d"]) == 0
    shown = capsys.readouterr().out
    assert "planar laser scanner" in shown
    assert "crowdbot.plugins.sensors.lidar2d_build:build" in shown
    assert "kind: lidar2d" in shown
    rows = {line.split()[0]: line.split() for line in shown.splitlines() if line.strip()}
    assert " ".join(rows["rate"][:9]) == "rate number > 0 and ≤ 128 Hz 16"
    assert rows["mount.yaw"][2] == "rad"


@pytest.mark.slow
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


def test_what_is_built_in_is_described_where_it_says() -> None:
    import re

    from crowdbot.cli.output.component_page import reference

    root = ROOT
    registry = discover(allow=())
    for plugin in registry.plugins:
        for component in plugin.components:
            page, _, anchor = reference(component, plugin).partition("#")
            text = (root / page).read_text(encoding="utf-8")
            assert re.search(rf"^#+ `?{anchor or component.kind}`?$", text, re.M | re.I), (
                component.kind
            )
            assert component.kind in text


def test_show_says_where_a_component_is_from(capsys: Captured) -> None:
    assert main(["plugins", "show", "risk"]) == 0
    shown = capsys.readouterr().out
    assert f"from crowdbot {metadata.version('crowdbot')} (plugin builtin)" in shown
    assert "described in docs/reference/metrics/risk.md" in shown
    assert "R in s, better: lower" in shown
    assert main(["plugins", "show", "risk", "--json"]) == 0
    (about,) = json.loads(capsys.readouterr().out)
    assert about["label"]["symbol"] == "R"
    assert (about["plugin"], about["pinned"]) == ("builtin", True)


def test_checks_of_one_kind(capsys: Captured) -> None:
    assert main(["plugins", "check", "goal_seek"]) == 0
    shown = capsys.readouterr().out
    assert "check_build_resolves" in shown
    assert shown.splitlines()[-1].startswith("1 component: ")
    assert main(["plugins", "check", "goal_seek", "-q"]) == 0
    assert "check_build_resolves" not in capsys.readouterr().out


def test_an_expected_failure_has_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    from crowdbot.cli.output import check as _check

    def check_bad(component: object) -> None:
        """Fails. If this fails, rejoice."""
        raise AssertionError(f"bad {component is not None}")

    def check_good(component: object) -> None:
        """Passes."""

    registry = discover(allow=())
    component = registry.find("planner", "goal_seek")
    monkeypatch.setattr(_check, "_checks", lambda _: (check_bad, check_good))
    failed, passed = _check.run_checks(component, registry)
    assert (failed.result, failed.reason, failed.advice) == ("failed", "bad True", "rejoice.")
    assert (passed.result, passed.bad) == ("passed", False)
    both = {"check_bad": "known", "check_good": "hoped"}
    monkeypatch.setattr(_check, "_exceptions", lambda _: both)
    expected, unexpected = _check.run_checks(component, registry)
    assert (expected.result, expected.reason, expected.bad) == ("expected failure", "known", False)
    assert (unexpected.result, unexpected.bad) == ("unexpected pass", True)


def test_options_of_the_list_do_not_stand_before_a_command(capsys: Captured) -> None:
    assert main(["plugins", "--json", "show", "risk"]) == 2
    assert "stand behind it" in capsys.readouterr().err
