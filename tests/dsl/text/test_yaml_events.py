"""Two parsers of YAML: where the quick one answers, it says what the other one says."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from crowdbot.dsl.text.yaml_events import events_of, quick_events

ROOT = Path(__file__).parents[3]
DOCUMENTS = sorted((ROOT / "scenario_specs").rglob("*.yaml"))
LINES = [line for file in DOCUMENTS for line in file.read_text().split("\n")]
#: Characters that mean something in YAML, and some that mean nothing.
LETTERS = "ab01:-[]{}?,&*!|>'\"%@`#. \n\t~<=\\/é𝄞\xa0\x85\u2028\ufeff"


def _said(events: Any) -> list[Any]:
    """Kind, place and content of each event; where something ends says nothing."""
    found = []
    for event in events:
        kind, start, end = type(event).__name__, event.start_mark, event.end_mark
        if kind.endswith("EndEvent") or kind == "StreamStartEvent":
            found.append((kind,))
            continue
        width = end.column - start.column if end.line == start.line else None
        content = (event.value, event.implicit[0]) if kind == "ScalarEvent" else ()
        found.append((kind, start.line, start.column, width, *content))
    return found


def _ruamel(text: str) -> list[Any] | None:
    """What ruamel.yaml says; None if it refuses the text."""
    try:
        return _said(YAML(typ="safe", pure=True).parse(text))
    except (YAMLError, ValueError, OverflowError):
        return None


@pytest.mark.parametrize("file", DOCUMENTS, ids=lambda f: f.stem)
def test_packaged_documents_are_read_quickly(file: Path) -> None:
    quick = quick_events(file.read_text())
    assert quick is not None
    assert _said(quick) == _ruamel(file.read_text())


@st.composite
def _spoilt(draw: st.DrawFn) -> str:
    """Some lines of a packaged document with characters gone and others put in."""
    first = draw(st.integers(0, len(LINES) - 1))
    text = "\n".join(LINES[first : first + draw(st.integers(1, 8))])
    for _ in range(draw(st.integers(0, 4))):
        at = draw(st.integers(0, len(text)))
        gone = draw(st.integers(0, 2))
        text = text[:at] + draw(st.text(LETTERS, max_size=2)) + text[at + gone :]
    return text.rstrip("\n") + "\n"


@settings(max_examples=300)
@given(_spoilt() | st.text(LETTERS, max_size=20).map(lambda text: text + "\n"))
@example('{"a":1}\n')
@example("a: |\n#\n")
@example("a: >#b\n")
@example("? a\n")
@example("a: # nothing\nb: 1\n")
@example("a:\n")
@example("a: b\x85c: d\n")
@example("\ufeffa: b\n")
@example("%YAML 1.1\n---\na: b\n")
@example("--- a\n")
@example("{a: [1, 'x y'], b: 2}\n")
def test_the_quick_parser_says_the_same_or_nothing(text: str) -> None:
    quick = quick_events(text)
    if quick is not None:
        assert _said(quick) == _ruamel(text)


@pytest.mark.parametrize(
    "text", ["a: b", "a: &x b\n", "a: !!int 1\n", "a: *x\n", "a:\tb\n", "a: [\n", "a: b\n---\n"]
)
def test_what_is_unusual_or_wrong_is_not_read_quickly(text: str) -> None:
    assert quick_events(text) is None


def test_without_libyaml_the_other_parser_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "a: {b: [1, 2]}\n"
    quick = _said(events_of(text))
    monkeypatch.setitem(sys.modules, "yaml", None)
    assert quick_events(text) is None
    assert _said(events_of(text)) == quick
