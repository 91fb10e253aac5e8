"""What ``import crowdbot`` offers, and what it costs."""

from __future__ import annotations

import subprocess
import sys

import pytest

import crowdbot

NAMES = [
    "Commands",
    "CrowdbotError",
    "Questionnaires",
    "Run",
    "Scenario",
    "Score",
    "Scores",
    "Suite",
    "Trajectories",
    "evaluate",
    "expand",
    "load",
    "results",
    "score",
    "simulate",
]


def test_all_is_what_was_promised() -> None:
    assert crowdbot.__all__ == NAMES
    assert dir(crowdbot) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_every_name_resolves(name: str) -> None:
    assert callable(getattr(crowdbot, name))


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="simulato"):
        crowdbot.simulato  # noqa: B018


def _loaded_by(statement: str) -> set[str]:
    code = f"import sys\n{statement}\nprint(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return {m.partition(".")[0] for m in done.stdout.split()}


def test_import_loads_nothing_heavy() -> None:
    loaded = _loaded_by("import crowdbot")
    assert "crowdbot" in loaded
    assert not loaded & {"numpy", "numba", "pydrake", "pydantic", "typer", "rich", "pluggy"}


def test_loading_a_suite_needs_neither_numbers_nor_drake() -> None:
    loaded = _loaded_by("import crowdbot; assert crowdbot.load('challenge-2020').scenarios")
    assert "pydantic" in loaded
    assert not loaded & {"numpy", "numba", "pydrake"}


def test_trajectories_need_no_drake() -> None:
    assert not _loaded_by("import crowdbot; crowdbot.Trajectories; crowdbot.score") & {"pydrake"}
