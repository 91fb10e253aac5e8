"""The atlas finds what was planted: an axis, a duration, a floor that loses, a copy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from crowdbot.cli.output.atlas_page import atlas_page
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import ScoreRow
from crowdbot.core.statistics.atlas import atlas, rank_correlation
from crowdbot.errors import UnknownNameError
from tests.core.results.made_up_record import changed
from tests.core.statistics.made_up_results import run, score

LABELS = ("sparse", "dense")


def planted() -> Results:
    """``axis`` follows the density, ``time`` the duration, ``skill`` the planner, ``copy`` it."""
    rng = np.random.default_rng(4)
    runs, scores = [], list[ScoreRow]()
    for planner, skill in (("goal_seek", 0.0), ("clever", 5.0)):
        for i in range(24):
            label, lasted = i % 2, float(rng.uniform(10, 100))
            r = run(
                planner, f"s{i}", f"d{i}", axes={"density": LABELS[label]}, sim_time=lasted,
                role="floor" if planner == "goal_seek" else "candidate",
            )  # fmt: skip
            runs.append(r)
            own = skill + rng.normal()
            made = {
                "axis": 10.0 * label + rng.normal(),
                "time": lasted + 0.1 * rng.normal(),
                "skill": own,
                "copy": -(own**3),
                "noise": rng.normal(),
            }
            scores += [score(r, float(v), metric=m) for m, v in made.items()]
    return Results(runs=tuple(runs), scores=tuple(scores))


def test_what_was_planted_is_found() -> None:
    found = {e.metric: e for e in atlas(planted())}
    assert found["axis"].moves[0][0] == "density"
    assert found["axis"].moves[0][1] > 0.9
    assert dict(found["noise"].moves).get("density", 0.0) < 0.3
    assert found["time"].duration is not None
    assert found["time"].duration > 0.99
    assert found["skill"].separation is not None
    assert found["skill"].separation[0] > 0.95
    assert found["noise"].separation is not None
    assert 0.2 < found["noise"].separation[0] < 0.8
    ((name, rho),) = found["skill"].repeats
    assert name == ("copy", "corrected")
    assert rho == pytest.approx(-1.0)
    assert found["noise"].repeats == ()


def test_floors_are_named_or_known() -> None:
    results = planted()
    assert atlas(results, ["goal_seek"]) == atlas(results)
    assert atlas(results, ["clever"]) != atlas(results)
    named_like_a_floor = replace(
        results, runs=tuple(changed(r, role="candidate") for r in results.runs)
    )
    assert all(entry.separation is None for entry in atlas(named_like_a_floor))
    with pytest.raises(UnknownNameError, match="goal_sek"):
        atlas(results, ["goal_sek"])


def test_ties_have_their_mean_rank() -> None:
    a = np.array([1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
    assert rank_correlation(a, a) == pytest.approx(1.0)
    assert rank_correlation(a, -a) == pytest.approx(-1.0)
    assert rank_correlation(a, 0 * a) is None
    assert rank_correlation(a[:7], a[:7]) is None
    assert rank_correlation(np.where(a > 6, np.nan, a), a) is None


def test_nothing_at_all() -> None:
    assert atlas(Results()) == ()
    assert atlas_page({}).startswith("# Atlas")


def test_the_page() -> None:
    text = atlas_page({"suite": atlas(planted())})
    row = next(line for line in text.splitlines() if line.startswith("| skill"))
    assert "copy -1.00" in row
    assert text.count("\n| copy") == 1
