"""The net for retired words: what it finds, and what it leaves alone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from scripts import check_vocabulary as vocabulary


def found(text: str, suffix: str = ".py") -> list[str]:
    return [word for _, word, _ in vocabulary.findings(text, suffix)]


@pytest.mark.parametrize(("text", "words"), [
    ("the LocalCrew of a crew", ["LocalCrew", "crew"]),
    ("write a file aside", ["write a file aside"]),
    ("a metric's laws", ["laws"]),
    ("Deeds of a plugin", ["Deeds"]),
    ("the\n    same\n    words", ["same words"]),
    ("x is no number", ["is no"]),
    ("outlines that are no discs", ["are no"]),
    ("what is\nno number", ["is no"]),
    ("it is none", ["is none"]),
])  # fmt: skip
def test_retired_words_are_found(text: str, words: list[str]) -> None:
    assert found(text) == words


@pytest.mark.parametrize("text", [
    "there is no number", "there\n    are none", "it is no longer there", "is no farther away",
    "one is None", "power law", "ahead, aside = c, s", "lawsuit", "a screw", "is none of them",
    "no step", "some words",
])  # fmt: skip
def test_other_meanings_are_left_alone(text: str) -> None:
    assert found(text) == []


@pytest.mark.parametrize("rule", vocabulary.RULES + vocabulary.PLAIN, ids=lambda r: r.pattern[:20])
def test_a_rule_finds_what_its_pattern_does(rule: vocabulary.Rule) -> None:
    for file in ("tests/test_check_vocabulary.py", "scripts/check_vocabulary.py"):
        text = (vocabulary.ROOT / file).read_text("utf-8")
        text += text.replace(" ", "x") + text.replace(" ", "\n")
        expected = [found.span() for found in re.finditer(rule.pattern, text)]
        assert [found.span() for found in vocabulary.matches(rule.pattern, text)] == expected


def test_a_rule_holds_in_its_files_only() -> None:
    assert found("chatter", ".md") == ["chatter"]
    assert found("chatter", ".py") == []


def test_a_finding_has_its_line() -> None:
    ((line, word, instead),) = vocabulary.findings("a\nb\nan entrant", ".md")
    assert (line, word) == (3, "entrant")
    assert instead == "planner entry"


def test_the_exit_code_and_the_message(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    good, bad = tmp_path / "good.md", tmp_path / "bad.md"
    good.write_text("a worker pool\n")
    bad.write_text("\nthe workshop\n")
    assert vocabulary.main([str(good)]) == 0
    assert capsys.readouterr().out == ""
    assert vocabulary.main([str(good), str(bad)]) == 1
    assert capsys.readouterr().out == f"{bad}:2: workshop -> executor, execute\n"


@pytest.mark.slow
def test_the_repository_has_none() -> None:
    assert vocabulary.main([]) == 0


def test_files_are_read_where_they_should_be() -> None:
    names = {f.relative_to(vocabulary.ROOT).as_posix() for f in vocabulary.files_to_read()}
    assert {"README.md", "crowdbot/api.py", "docs/index.md", "tests/paths.py"} <= names
    assert not names & set(vocabulary.EXEMPT)


@pytest.mark.parametrize(("code", "words"), [
    ('def f():\n    """Whether it is."""\n', ['"""Whether']),
    ("x = 1  # Of a file", ["# Of"]),
    ("nobody = 1  # nobody", ["nobody"]),
    ('x = "drawn anew"', ["anew"]),
    ('def f():\n    """Return True if it is."""\n', []),
])  # fmt: skip
def test_prose_of_the_package_is_plain(code: str, words: list[str]) -> None:
    prose = vocabulary.prose(code)
    assert [word for _, word, _ in vocabulary.findings(prose, ".py", vocabulary.PLAIN)] == words


def test_pages_are_plain() -> None:
    page = "Whether nobody, somebody or he draws them anew, for ever."
    found = [word for _, word, _ in vocabulary.findings(page, ".md", vocabulary.PLAIN)]
    assert sorted(found) == ["anew", "for ever", "he", "nobody", "somebody"]


@pytest.mark.parametrize(("name", "plain"), [
    ("README.md", True), ("docs/index.md", True), ("docs/conf.py", True),
    ("crowdbot/core/report/app.js", True), ("crowdbot/core/report/page.html.j2", True),
    ("tests/paths.py", False), ("docs/examples/planners/a.toml", False),
])  # fmt: skip
def test_places_with_plain_prose(name: str, plain: bool) -> None:
    assert vocabulary.is_plain_place(vocabulary.ROOT / name) is plain
