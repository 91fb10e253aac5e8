"""Every page: links, code blocks, commands, decisions."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import crowdbot
from crowdbot.cli import command_names, main
from crowdbot.cli.app.typer_app import load
from crowdbot.core.environments.build import build_environment
from crowdbot.core.scenarios.library import pick
from tests.docs.doc_pages import (
    PAGES,
    anchors,
    blocks,
    commands,
    links,
    name_of,
    read,
    sessions,
)
from tests.paths import ROOT

FILES = sorted(
    f
    for kind in ("**/*.py", "**/*.yaml", "**/*.urdf", "**/pyproject.toml", "*.csv")
    for f in ROOT.glob(f"docs/*/files/{kind}")
)
#: Pages whose commands are run where their files are.
BESIDE_FILES = ("docs/howto", "docs/tutorial/first_scenario", "docs/explanation/pitfalls")


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_relative_links_resolve(page: Path) -> None:
    for link in links(page):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), f"{link} leads nowhere"
        if anchor and target.suffix == ".md":
            assert anchor in anchors(target), f"{link}: no such heading"


def test_links_outside_the_repository_are_few_and_known() -> None:
    known = {
        "https://drake.mit.edu",
        "https://keepachangelog.com/en/1.1.0/",
        "https://mcap.dev",
        "https://semver.org/spec/v2.0.0.html",
    }
    found = {link for page in PAGES for link in links(page) if re.match(r"[a-z]+:", link)}
    assert found <= known, f"check these by hand, then add them: {found - known}"


def test_the_index_lists_every_page() -> None:
    index = ROOT / "docs" / "index.md"
    others = [
        ROOT / "docs" / f"{name}.md"
        for name in (
            "reference/metrics",
            "reference/scenario",
            "reference/planners",
            "reference/crowd",
            "developers/index",
        )
    ]
    listed = {
        (page.parent / link.partition("#")[0]).resolve()
        for page in (index, *others)
        for link in links(page)
    }
    pages = {p.resolve() for p in (ROOT / "docs").rglob("*.md")} - {index.resolve()}
    assert pages - listed == set()


def test_blocks_that_name_a_file_equal_it() -> None:
    named = [b for page in PAGES for b in blocks(page) if b.names is not None]
    for block in named:
        assert block.names is not None
        assert block.text == block.names.read_text(encoding="utf-8"), block.names
    shown = {b.names.resolve() for b in named if b.names is not None}
    packages = {f for f in shown if f.is_relative_to(ROOT / "docs/examples")}
    assert shown - packages == {f.resolve() for f in FILES}


def test_commands_in_the_text_exist() -> None:
    found = list(commands())
    assert len(found) > 20
    for page, words in found:
        where = f"{page}: {' '.join(words)}"
        assert words[0] in command_names(), where
        command = load(words[0])
        if words[1:2] and words[1] in getattr(command, "commands", {}):
            command = command.commands[words[1]]
        known = {o for p in command.params for o in (*p.opts, *p.secondary_opts)}
        assert {w for w in words if w.startswith("-")} <= known, where


def _cheap(words: list[str], output: list[str]) -> bool:
    """Whether the shown output comes without simulating anything."""
    plain = words[0] in ("expand", "validate") and "scenario.yml" not in words
    return bool(output) and (plain or output[0].startswith(("error: ", "--set:")))


SHOWN = [(p, w, o) for p, w, o in sessions() if _cheap(w, o)]


@pytest.mark.parametrize(("page", "words", "output"), SHOWN, ids=[" ".join(w) for _, w, _ in SHOWN])
def test_shown_output_is_what_comes(
    page: str,
    words: list[str],
    output: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    beside = page.startswith(BESIDE_FILES)
    monkeypatch.chdir((ROOT / page).parent / "files" if beside else ROOT)
    main(words)
    captured = capsys.readouterr()
    assert (captured.out + captured.err).splitlines() == output


def test_scenarios_in_the_text_exist() -> None:
    suite = crowdbot.load("challenge-2020")
    assert isinstance(suite, crowdbot.Suite)
    ids = [w[2] for _, w in commands() if w[:2] == ["simulate", "challenge-2020"]]
    assert ids
    for wanted in ids:
        if wanted == "counter-d0250":  # stands for a message about something else
            continue
        assert pick(suite, wanted).id == wanted


def test_the_suite_of_the_howto_expands() -> None:
    suite = crowdbot.load(ROOT / "docs" / "howto" / "files" / "my_suite.yaml")
    assert isinstance(suite, crowdbot.Suite)
    assert [s.id for s in suite.scenarios] == ["in-few", "in-many", "counter-few", "counter-many"]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "number"), [("own_arrays", 0), ("own_tables", 1)])
def test_own_data_print_what_the_page_shows(name: str, number: int) -> None:
    page = ROOT / "docs" / "howto" / "score_own_data.md"
    shown = [b.text for b in blocks(page) if b.language == "text"][number]
    script = ROOT / "docs" / "howto" / "files" / f"{name}.py"
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert [line.rstrip() for line in done.stdout.splitlines()] == [
        line.rstrip() for line in shown.splitlines()
    ]


@pytest.mark.slow
def test_the_crowd_alone_prints_what_the_page_shows() -> None:
    page = ROOT / "docs" / "howto" / "simulate_a_crowd.md"
    (shown,) = (b.text for b in blocks(page) if b.language == "text")
    script = ROOT / "docs" / "howto" / "files" / "crowd_alone.py"
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert done.stdout == shown


@pytest.mark.slow
def test_the_diagram_of_a_run_can_be_drawn(tmp_path: Path) -> None:
    script = ROOT / "docs" / "howto" / "files" / "draw_diagram.py"
    subprocess.run([sys.executable, script], cwd=tmp_path, check=True)
    drawn = (tmp_path / "diagram.dot").read_text(encoding="utf-8")
    for name in ("plant", "planner", "crowd"):
        assert f"name={name}" in drawn


@pytest.mark.slow
def test_people_get_through_the_floor_of_the_howto() -> None:
    from crowdbot.core.population.realise import realise
    from crowdbot.core.registry.registry import discover
    from crowdbot.core.sim.build_crowd import build_crowd

    suite = crowdbot.load(ROOT / "docs" / "howto" / "files" / "my_floor.yaml")
    assert isinstance(suite, crowdbot.Suite)
    assert [s.id for s in suite.scenarios] == ["heeded", "ignored"]
    scenario, registry = suite.scenarios[0], discover(allow=())
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, realise(scenario), parts, registry)
    assert engine is not None
    _, place = engine.run(30.0)
    assert np.nanmax(np.abs(place[..., 1])) < 6.0
    back = np.diff(place[..., 0], axis=0) < -10.0  # through the portal
    assert np.sum(back) >= 0.9 * len(engine.agents)


def test_decisions_are_numbered_and_whole() -> None:
    decisions = sorted((ROOT / "docs" / "decisions").glob("*.md"))
    numbers = [int(d.name[:4]) for d in decisions]
    assert numbers == sorted(set(numbers)), "each number once"
    for decision in decisions:
        text = decision.read_text(encoding="utf-8")
        assert text.startswith(f"# {decision.name[:4]} "), decision.name
        assert re.search(r"^- Status: (accepted|replaced)", text, re.M), decision.name
        assert re.search(r"^- Date: 20\d\d-\d\d-\d\d$", text, re.M), decision.name
        for part in ("## Context", "## Decision", "## Consequences"):
            assert part in text, f"{decision.name}: {part}"


def test_decisions_that_the_code_refers_to_exist() -> None:
    mentioned = {
        number
        for file in (ROOT / "crowdbot").rglob("*.py")
        for number in re.findall(r"docs/decisions/(\d{4})", file.read_text(encoding="utf-8"))
    }
    written = {d.name[:4] for d in (ROOT / "docs" / "decisions").glob("*.md")}
    assert "0004" in mentioned
    assert mentioned <= written


def test_every_dependency_has_a_reason() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    groups = project["dependency-groups"]
    listed = [*project["project"]["dependencies"], *groups["build"], *groups["dev"]]
    names = {re.split(r"[<>=!~\[ ]", entry)[0] for entry in listed if isinstance(entry, str)}
    given = set(re.findall(r"^\| ([\w.-]+) \|", read("decisions/0001-dependencies.md"), re.M))
    assert given - {"package"} == names


def test_every_metric_has_a_page() -> None:
    pages = {p.stem for p in (ROOT / "docs" / "reference" / "metrics").glob("*.md")}
    from crowdbot.core.registry.registry import discover

    assert set(discover(allow=()).components("metric")) <= pages


def test_the_picture_is_small() -> None:
    picture = ROOT / "docs" / "images" / "replay.png"
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert picture.stat().st_size < 300_000
