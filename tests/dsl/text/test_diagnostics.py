"""Golden diagnostics: each ``NAME.yaml`` gives exactly the text of ``NAME.txt``.

To write the texts again after a wanted change: CROWDBOT_WRITE_GOLDEN=1 pytest tests/dsl
"""

from __future__ import annotations

import os
import re
from importlib import metadata

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import installed
from crowdbot.dsl.suite.expand import expand_document, load_document
from crowdbot.dsl.text.diagnostics import CODES, Diagnostic, Mark, Source, render
from crowdbot.errors import SpecError
from tests.paths import DATA, ROOT

DATA = DATA / "diagnostics"
DOCS = ROOT / "docs" / "reference" / "errors.md"
REGISTRY = discover(allow=())
CASES = sorted(p.stem for p in DATA.glob("*.yaml"))


def errors_of(name: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(SpecError) as caught:
        expand_document(
            load_document(
                DATA / f"{name}.yaml", name=f"{name}.yaml", installed=installed(REGISTRY)
            ),
            REGISTRY.scenario_model,
        )
    return caught.value.diagnostics


@pytest.mark.parametrize("name", CASES)
def test_text_is_the_golden_one(name: str) -> None:
    text, golden = render(errors_of(name)) + "\n", DATA / f"{name}.txt"
    own = metadata.version("crowdbot")
    text = text.replace(f"crowdbot {own} ", "crowdbot VERSION ")
    text = text.replace(f"this is {own},", "this is VERSION,")
    if os.environ.get("CROWDBOT_WRITE_GOLDEN"):
        golden.write_text(text, encoding="utf-8")
    assert text == golden.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [c for c in CASES if c.startswith("E")])
def test_code_is_that_of_the_file_name(name: str) -> None:
    assert name.partition("_")[0] in {d.code for d in errors_of(name)}


def test_every_code_has_a_golden_pair() -> None:
    other = {"E301", "E401", "E402", "E403"}  # of plugins, and of files of other programs
    assert {c.partition("_")[0] for c in CASES if c.startswith("E")} == set(CODES) - other
    assert {p.stem for p in DATA.glob("*.txt")} == set(CASES)


def test_every_code_is_documented_once() -> None:
    headings = re.findall(r"^## (E\d{3}): (.+)$", DOCS.read_text(encoding="utf-8"), re.MULTILINE)
    assert headings == sorted(CODES.items())


def test_every_documented_code_has_an_example() -> None:
    sections = re.split(r"^## ", DOCS.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    assert all("```" in section for section in sections)


def test_long_lines_are_cut_around_the_caret() -> None:
    source = Source("f.yaml", ("x" * 5000 + "BAD" + "y" * 5000,))
    shown = render([Diagnostic("E102", "no", Mark(source, 0, 5000, 3))]).split("\n")
    assert len(shown[1]) < 120
    assert shown[1][shown[2].index("^") :].startswith("BAD")


def test_tabs_do_not_move_the_caret() -> None:
    source = Source("f.yaml", ("\t\tBAD",))
    shown = render([Diagnostic("E102", "no", Mark(source, 0, 2, 3))]).split("\n")
    assert shown[1].index("BAD") == shown[2].index("^^^")


def test_what_is_said_of_many_places_is_said_a_few_times() -> None:
    source = Source("f.yaml", ("x" * 900,))
    many = [Diagnostic("E004", "alias 'a'", Mark(source, 0, i)) for i in range(900)]
    shown = render([*many, Diagnostic("E102", "another", Mark(source))])
    assert shown.count("f.yaml:1:") == 11
    assert "f.yaml: error[E004] alias 'a': 890 more of them\n901 errors" in shown
    assert "890" not in render(many[:10])
