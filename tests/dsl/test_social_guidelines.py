"""The suite of small encounters: cards, numbers of people, ids that do not depend on places."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.dsl.suite.expansion import Expansion
from tests.paths import ROOT

REGISTRY = discover(allow=())
SPEC = ROOT / "scenario_specs" / "social-guidelines.yaml"
PAGE = (ROOT / "docs" / "reference" / "suites" / "social_guidelines.md").read_text()
CARDS = re.findall(
    r"^\| `(\w+)`(\*?) \| ([^|]+) \((\d)\) \| ([^|]+) \| ([^|]+) \|$", PAGE, re.MULTILINE
)


@pytest.fixture(scope="module")
def suite() -> Expansion:
    return open_spec("social-guidelines", REGISTRY)


def hashes_of(suite: Expansion) -> dict[str, str]:
    return {s.id: content_hash(s, REGISTRY.spec_versions(s)) for s in suite.scenarios}


def test_every_encounter_has_its_card_and_no_other(suite: Expansion) -> None:
    labels = [s.id for s in suite.scenarios]
    assert [card[0] for card in CARDS] == labels
    assert 30 <= len(labels) <= 40
    for scenario, (_, _, title, count, *words) in zip(suite.scenarios, CARDS, strict=True):
        assert scenario.title == title
        assert scenario.crowd is not None
        assert len(scenario.crowd.agents) == int(count) <= 8
        assert all(word.strip() for word in words)


def test_the_paper_s_scenarios_are_counted(suite: Expansion) -> None:
    named = [card for card in CARDS if not card[1]]  # a star marks those that it does not have
    assert len(named) == 25
    assert len(suite.scenarios) - len(named) == 13


def test_ids_and_hashes_do_not_depend_on_the_place_of_a_label(
    suite: Expansion, tmp_path: Path
) -> None:
    text = SPEC.read_text()
    head, axis, rest = text.partition("  encounter:\n")
    body, tail, end = rest.partition("references:")
    labels = re.split(r"(?m)^(?=    \w)", body)[1:]
    turned = tmp_path / "social-guidelines.yaml"
    whole = "".join([head, axis, *reversed(labels), tail, end])
    turned.write_text(whole.replace("parts/", "builtin:parts/"))
    other = open_spec(str(turned), REGISTRY)
    assert hashes_of(other) == hashes_of(suite)


def test_metrics_that_the_page_names_exist() -> None:
    table = PAGE.partition("| metric of the paper |")[2]
    known = {page.stem for page in (ROOT / "docs" / "reference" / "metrics").glob("*.md")}
    assert set(re.findall(r"`(\w+)`", table)) <= known
