"""Which scores are ranked, and which way: what would reward the wrong thing is not."""

from __future__ import annotations

import pytest

from tests.built_in import built_in_metrics

BY_KIND = {c.kind: c for c in built_in_metrics()}


def directions(kind: str) -> dict[str, str]:
    return {name: v.better for name, v in BY_KIND[kind].variants.items()}


@pytest.mark.parametrize("kind", ["mean_planner_time", "max_planner_time"])
def test_the_wall_clock_ranks_nobody(kind: str) -> None:
    assert set(directions(kind).values()) == {"none"}


@pytest.mark.parametrize(
    "kind", ["risk", "expected_severity", "time_exposed", "integrated_time_to_collision"]
)
def test_what_grows_with_time_ranks_nobody(kind: str) -> None:
    ranked = {name for name, better in directions(kind).items() if better != "none"}
    assert ranked - {"disc"} == {"rate"}  # that of a disc is a rate, too


@pytest.mark.parametrize("kind", ["effect_on_time", "effect_on_velocity", "neighbours_velocity"])
def test_the_best_crowd_walks_as_it_does_alone(kind: str) -> None:
    """The seed's directions stay those of the seed's formula."""
    found = directions(kind)
    assert found.pop("literal") in ("higher", "lower")
    assert set(found.values()) == {"reference"}


@pytest.mark.parametrize("kind", ["displacement", "delay"])
def test_chaos_ranks_nobody(kind: str) -> None:
    assert directions(kind)["whole"] == "none"
    assert directions(kind)["corrected"] == "lower"
