"""Samples of scenarios: as many crowds as there can be, the same each time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.campaign.sample import sample
from crowdbot.core.runs.identity import Prepared


@dataclass(frozen=True)
class _Named:
    id: str


@dataclass(frozen=True)
class _People:
    agents: tuple[int, ...]


@dataclass(frozen=True)
class _Trial:
    scenario: _Named
    people: _People
    realisation: str


@dataclass(frozen=True)
class _Prepared:
    run: _Trial


def suite(draws: list[int], people: int = 1) -> list[Prepared]:
    """One scenario for each number, which is its crowd."""
    made: list[Any] = [
        _Prepared(_Trial(_Named(f"s{i}"), _People((0,) * people), f"d{draw}"))
        for i, draw in enumerate(draws)
    ]
    return cast(list[Prepared], made)


@given(st.lists(st.integers(0, 5), max_size=40), st.integers(0, 50), st.text(max_size=4))
def test_as_many_crowds_as_there_can_be(draws: list[int], count: int, name: str) -> None:
    everything = suite(draws)
    chosen = sample(everything, count, name)
    assert len(chosen) == min(count, len(everything))
    assert len({c.run.realisation for c in chosen}) == min(len(chosen), len(set(draws)))
    places = [everything.index(c) for c in chosen]
    assert places == sorted(set(places))
    assert chosen == sample(everything, count, name)


def test_the_challenge_gives_one_scenario_for_each_crowd() -> None:
    everything = suite([i // 9 for i in range(162)])
    assert len({c.run.realisation for c in sample(everything, 18, "challenge-2020")}) == 18


def test_another_suite_has_another_sample() -> None:
    everything = suite([0] * 100)
    assert sample(everything, 10, "a") != sample(everything, 10, "b")


def test_without_people_every_scenario_is_different() -> None:
    """All of them have the hash of an empty table, which nobody shares."""
    everything = suite([0, 0, 1, 1], people=0)
    assert len(sample(everything, 3, "a")) == 3
