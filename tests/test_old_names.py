"""Old names of what plugins use work until 1.0, with a warning that says the new."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import crowdbot
from crowdbot import dsl, plugin
from crowdbot.core import interfaces
from crowdbot.core.recording import old_names as old_readers
from crowdbot.core.registry.old_hooks import OLD_HOOKS
from crowdbot.core.registry.registry import discover
from crowdbot.dsl.spec.component_specs import CATEGORIES
from crowdbot.old_names import OldNameWarning, collected_old_names, say_old_names

OLD_PLUGIN = """
from typing import Literal
from crowdbot.core.interfaces import Command
from crowdbot.dsl import Component, PlannerSpec
from crowdbot.hookspecs import hookimpl

class Spec(PlannerSpec):
    \"\"\"Stands.\"\"\"
    kind: Literal["aged.stand"] = "aged.stand"

class Stand:
    def __init__(self, spec): ...
    def reset(self, task, limits, sensors, seed): ...
    def step(self, obs): return Command(0.0, 0.0)

@hookimpl
def crowdbot_planners():
    return [Component(spec=Spec, build="aged:Stand", summary="stands")]
"""
FILE = "from crowdbot.core.interfaces import Command, Observation\n\nclass Stand:\n"
FILE += "    def reset(self, task, limits, sensors, seed): ...\n"
FILE += "    def step(self, obs): return Command(0.0, 0.0)\n"


@pytest.mark.parametrize("old", [interfaces, dsl])
def test_an_old_module_forwards_and_warns(old: object) -> None:
    with pytest.warns(OldNameWarning, match=r"ends with crowdbot 1\.0: import from crowdbot\.plug"):
        assert old.Component is plugin.Component  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="has no attribute 'Nothing'"):
        _ = old.Nothing  # type: ignore[attr-defined]


def test_every_category_had_a_hook() -> None:
    later = {"observation", "reward"}  # had no hook of their own
    assert sorted(OLD_HOOKS.values()) == sorted({c.category for c in CATEGORIES} - later)


def test_lines_are_collected_and_said_once(caplog: pytest.LogCaptureFixture) -> None:
    with collected_old_names() as lines, collected_old_names() as inner:
        say_old_names(["a.py:1: old"])
    assert (lines, inner) == ([], ["a.py:1: old"])
    for _ in range(2):
        say_old_names(inner)
    assert [r.getMessage() for r in caplog.records] == ["warning: a.py:1: old"]


def test_an_old_plugin_warns_where_warnings_are_errors(tmp_path: Path) -> None:
    (tmp_path / "aged.py").write_text(OLD_PLUGIN)
    (aged,) = (p for p in discover(extra=[tmp_path / "aged.py"], allow=()).plugins if p.given)
    assert "OldNameWarning: crowdbot.core.interfaces is an old name" in aged.error
    sys.modules.pop("aged", None)


@pytest.mark.slow
def test_commands_say_each_old_name_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "aged.py").write_text(OLD_PLUGIN)
    done = _crowdbot(tmp_path, "plugins", "check", "--plugin", "aged.py")
    assert done.returncode == 0, done.stdout
    old = [line for line in done.stderr.splitlines() if line.startswith("warning: ")]
    assert [line.partition("aged.py:")[2] for line in old] == [
        "3: crowdbot.core.interfaces is an old name that ends with crowdbot 1.0: "
        "import from crowdbot.plugin",
        "4: crowdbot.dsl is an old name that ends with crowdbot 1.0: import from crowdbot.plugin",
        "16: crowdbot_planners is an old hook that ends with crowdbot 1.0: "
        "let crowdbot_components return {'planner': [...]}",
    ]


@pytest.mark.slow
def test_a_planner_process_says_it_too(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(FILE)
    done = _crowdbot(
        tmp_path, "simulate", "challenge-2020", "in-d0125-slow-c01-r02", "--planner",
        "mine.py:Stand", "--set", "robots.robot.task.time_limit=0.5 s",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    old = [line for line in done.stderr.splitlines() if "old name" in line]
    assert len(old) == 1
    assert old[0].endswith(
        "mine.py:1: crowdbot.core.interfaces is an old name that ends with crowdbot 1.0: "
        "import from crowdbot.plugin"
    )


def _crowdbot(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", crowdbot.__name__, *words],
        cwd=folder, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip


@pytest.mark.parametrize("name", old_readers.__all__)
def test_old_readers_warn_of_the_new_object(name: str) -> None:
    with pytest.warns(OldNameWarning, match=r"ends with crowdbot 1\.0: use crowdbot\.Recording"):
        assert getattr(interfaces, name) is getattr(old_readers, name)
