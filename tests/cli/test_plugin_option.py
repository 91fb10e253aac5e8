"""``--plugin``: documents with components that are not installed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from crowdbot.cli import main

PLUGIN = '''
from typing import Literal
from crowdbot.plugin import Component
from crowdbot.plugin import hookimpl
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec

class Omni(Turtlebot2Spec):
    """A robot."""
    kind: Literal["acme.omni"] = "acme.omni"

class Fast(Turtlebot2Spec):
    """Another one, whose kind begins with that of the first."""
    kind: Literal["acme.omni.fast"] = "acme.omni.fast"

BUILD = "crowdbot.plugins.robots.turtlebot2_build:build"

@hookimpl
def crowdbot_components():
    return {"robot": [Component(spec=s, build=BUILD, summary="a robot") for s in (Omni, Fast)]}
'''
SCENARIO = """\
crowdbot: 1
kinds: {acme.omni: 1, acme.omni.fast: 1}
scenario:
  id: two
  extends: "builtin:parts/corridor_50x10.yaml"
  robots:
    one: {model: {kind: acme.omni}, task: {start: [2, 0, 0], goal: {zone: robot_goal}}}
    two: {model: {kind: acme.omni.fast}, task: {start: [2, 2, 0], goal: {zone: robot_goal}}}
"""


@pytest.fixture
def option(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    monkeypatch.chdir(tmp_path)
    Path("acme.py").write_text(PLUGIN)
    Path("two.yaml").write_text(SCENARIO)
    yield ["--plugin", "acme.py"]
    sys.modules.pop("acme", None)


def said(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert main(list(words)) == 0
    return capsys.readouterr().out


@pytest.mark.usefixtures("option")
def test_without_the_plugin_its_kinds_are_unknown(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "two.yaml"]) == 1
    errors = capsys.readouterr().err
    assert errors.count("is the package providing 'acme' installed?") == 4
    assert "two.yaml:2:23: error[E120] unknown kind 'acme.omni.fast'" in errors


def test_a_resolved_document_asks_for_the_same_kinds(
    option: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    listed = said(capsys, "expand", "two.yaml", *option)
    resolved = said(capsys, "expand", "two.yaml", "--one", "two", *option)
    assert "kinds: {acme.omni: 1, acme.omni.fast: 1, corridor: 1}" in resolved
    Path("resolved.yaml").write_text(resolved)
    assert said(capsys, "expand", "resolved.yaml", *option) == listed


@pytest.mark.parametrize(
    "words",
    [
        ["validate", "two.yaml"],
        ["view", "two.yaml", "--out", "two.svg"],
        ["lock", "two.yaml"],
        ["diff", "two.yaml", "two.yaml"],
    ],
    ids=lambda words: words[0],
)
def test_other_commands_load_it(
    option: list[str], words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert said(capsys, *words, *option)


def test_the_schema_has_its_kinds(option: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert '"acme.omni.fast"' in said(capsys, "schema", "scenario", *option)


def test_a_newer_version_than_the_plugin_has_is_asked_for(
    option: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    Path("two.yaml").write_text(SCENARIO.replace("acme.omni: 1", "acme.omni: 2"))
    assert main(["validate", "two.yaml", *option]) == 1
    assert "two.yaml:2:20: error[E014] the document needs version 2" in capsys.readouterr().err
