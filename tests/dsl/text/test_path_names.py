"""Ids become folders: none leads out of the results, or takes a name that crowdbot needs."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.runs.run import Request
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.suite.suite_entry import SuiteEntry
from crowdbot.dsl.text.path_names import LONGEST, path_problem
from crowdbot.errors import InputError, SpecError
from tests.core.bundle.made_up_runs import registry

BAD = ("..", "/abs", "a/../b", "a/", "a//b", ".hidden", "x.partial", "x.partial-2", "x.old-12",
       "references", "a/references", "seed-0", "a/seed-12/b", "x.failure.json", "a" * 300,
       "\u00e9" * 150, "a\\b", "")  # fmt: skip
GOOD = ("a", "a/b", "in-d0125-c01-r02", "x+de08", "seed-x", "my.suite", "references2", "a..b")

WORLD = """\
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/turtlebot2.yaml"]
  robots.robot.task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}, time_limit: 2 s}
"""


@pytest.mark.parametrize("name", BAD)
def test_names_that_cannot_be_folders(name: str) -> None:
    assert path_problem(name)


@pytest.mark.parametrize("name", GOOD)
def test_names_that_can(name: str) -> None:
    assert path_problem(name) == ""


@given(st.text("ab./\\-+seedpartialold0123", max_size=30))
def test_what_passes_stays_below_the_root(name: str) -> None:
    if not path_problem(name):
        place = Path("/root/runs") / name / "planner" / "seed-0"
        assert place.resolve().is_relative_to("/root/runs")
        assert len(place.parts) >= 6
        assert ".partial" not in name


@pytest.mark.parametrize("name", ["..", "x.partial", "references", "a" * 300])
def test_documents_are_told_where(tmp_path: Path, name: str) -> None:
    file = tmp_path / "s.yaml"
    for text, line, column in (
        (f"crowdbot: 1\nscenario:\n  id: {name}\n{WORLD}", 3, 7),
        (f"crowdbot: 1\nsuite: {{id: {name}}}\nbase:\n{WORLD}", 2, 13),
    ):
        file.write_text(text)
        with pytest.raises(SpecError) as caught:
            open_spec(str(file), registry())
        found = caught.value.diagnostics[0]
        assert (found.code, found.mark.line + 1, found.mark.column + 1) == ("E116", line, column)


def test_ids_that_grow_too_long(tmp_path: Path) -> None:
    file, label = tmp_path / "s.yaml", "a" * 120
    axes = "".join(f"  x{i}: {{{label}: {{title: t}}}}\n" for i in range(1))
    axes += f"  y: {{{label}: {{contact.dissipation: 0.4 s/m}}}}\n"
    file.write_text(f"crowdbot: 1\nsuite: {{id: s}}\nbase:\n{WORLD}matrix:\n{axes}")
    with pytest.raises(SpecError, match=f"the id has 241 bytes; at most {LONGEST}") as caught:
        open_spec(str(file), registry())
    mark = caught.value.diagnostics[0].mark
    assert mark.source.lines[mark.line][mark.column :].startswith(label)


def test_ids_that_are_one_folder_on_some_disks(tmp_path: Path) -> None:
    file = tmp_path / "s.yaml"
    labels = "{a: {title: t}, b: {title: u}, A: {title: v}}"
    file.write_text(f"crowdbot: 1\nsuite: {{id: s}}\nbase:\n{WORLD}matrix:\n  x: {labels}\n")
    with pytest.raises(SpecError, match="the id 'A' is 'a' where file systems") as caught:
        open_spec(str(file), registry())
    assert str(caught.value.diagnostics[0].mark) == f"{file}:7:37"


def test_a_list_whose_entries_are_wrong_is_not_called_empty(tmp_path: Path) -> None:
    file = tmp_path / "s.yaml"
    file.write_text(f"crowdbot: 1\nsuite: {{id: s}}\nseeds: {{runs: [-1]}}\nbase:\n{WORLD}")
    with pytest.raises(SpecError) as caught:
        open_spec(str(file), registry())
    assert [d.code for d in caught.value.diagnostics] == ["E112"]
    file.write_text(f"crowdbot: 1\nsuite: {{id: s}}\nseeds: {{runs: []}}\nbase:\n{WORLD}")
    with pytest.raises(SpecError, match="at least 1"):
        open_spec(str(file), registry())


@pytest.mark.parametrize("suite", ["..", "a/../..", "references", "x.partial"])
def test_no_run_is_written_there(tmp_path: Path, suite: str) -> None:
    """Whatever a document or Python code got through."""
    file = tmp_path / "s.yaml"
    file.write_text(f"crowdbot: 1\nscenario:\n  id: fine\n{WORLD}")
    (scenario,) = open_spec(str(file), registry()).scenarios
    choice = resolve_planner("stand_still", registry())

    def directory(suite: str, name: str) -> Path:
        named = scenario.model_copy(update={"id": name})
        return Request(
            scenario=named,
            choice=choice,
            registry=registry(),
            seed=0,
            out=tmp_path,
            entry=SuiteEntry(suite=suite),
        ).directory

    assert directory("tiny", "fine") == tmp_path / "tiny/fine/stand_still/seed-0"
    for names in ((suite, "fine"), ("tiny", suite)):
        with pytest.raises(InputError, match="no folder can be called"):
            directory(*names)
