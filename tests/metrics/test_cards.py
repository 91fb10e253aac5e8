"""Every registered metric has a card that says what its scores say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from crowdbot.core.evaluate import score
from crowdbot.core.registry import discover

from .scenes import REGISTRY, grid, line, scene, scores_of

CARDS = Path(__file__).parents[2] / "docs/reference/metrics"
KINDS = sorted(REGISTRY.components("metric"))
T = grid(2)
RUN = scene(T, line(T, (0, 0), (1, 0)), [line(T, (5, 0), (-1, 0))], goal_time=2.0)


def card(kind: str) -> str:
    return (CARDS / f"{kind}.md").read_text(encoding="utf-8")


def cells(kind: str) -> dict[str, str]:
    """The table at the head of a card."""
    rows = re.findall(r"^\| ([\w ]+?) \| (.+?) \|$", card(kind).split("\n## ")[0], re.MULTILINE)
    return dict(rows)


@pytest.mark.parametrize("kind", KINDS)
def test_a_card_says_what_the_scores_say(kind: str) -> None:
    found = score(REGISTRY, RUN, RUN, RUN, metrics=kind)
    head = cells(kind)
    assert card(kind).startswith(f"# {kind}\n")
    for s in found:
        assert head["symbol"] == s.symbol
        assert head["unit"] == s.unit
        assert head["category"] == s.category
        assert re.search(rf"\b{s.better}\b", head["better"])
        assert f"`{s.variant}`" in card(kind)
        for extra in s.extras:
            assert f"`{extra}`" in card(kind)
    assert {"range", "needs"} <= set(head)


@pytest.mark.parametrize("kind", KINDS)
def test_a_card_has_all_its_sections(kind: str) -> None:
    sections = re.findall(r"^## (.+)$", card(kind), re.MULTILINE)
    assert sections == [
        "Formula",
        "Variants",
        "Failure modes",
        "What the literal form gets wrong",
        "Worked example",
        "Source",
    ]


@pytest.mark.parametrize("kind", KINDS)
def test_a_card_names_every_parameter(kind: str) -> None:
    fields = set(REGISTRY.find("metric", kind).spec.model_fields) - {"kind"}
    assert {f for f in fields if f"`{f}`" not in card(kind)} == set()


@pytest.mark.parametrize("kind", KINDS)
def test_a_card_names_the_reasons_that_occur(kind: str) -> None:
    lone = scene([0.0])
    still = scene(T, line(T, (0, 0), (1, 0)), robot_footprint=[[0, 0], [1, 0], [0, 1]])
    for crowded, alone in ((lone, None), (RUN, lone), (still, still), (RUN, still)):
        for s in scores_of(kind, crowded, alone, alone).values():
            assert not s.reason or f"`{s.reason}`" in card(kind)


def test_there_are_no_other_cards() -> None:
    assert sorted(p.stem for p in CARDS.glob("*.md") if p.stem != "index") == KINDS


def test_the_metrics_are_the_plugins() -> None:
    installed = discover(allow=(), entry_points=False).components("metric")
    assert sorted(installed) == KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_defaults_are_the_specifications(kind: str) -> None:
    expected = {
        "zero_tol": 1e-9,
        "jump_speed": 10.0,
        "risk_horizon": 5.0,
        "contact_tol": 1e-9,
        "rel_speed_tol": 1e-6,
        "release_gap": 0.05,
    }
    component = REGISTRY.find("metric", kind)
    fields = component.spec.model_validate({"kind": kind}).model_dump(exclude={"kind"})
    assert fields == {name: expected[name] for name in fields}
