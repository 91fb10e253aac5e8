"""Ranks by crowd: orders, Kendall's tau, verdicts weighted by realism, and a planted swap."""

from __future__ import annotations

import math

import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.statistics import crowds
from crowdbot.core.statistics.crowds import crowd_ranks, kendall
from tests.core.statistics.made_up_results import run, score

REALISM = {"calibrated": 0.9, "orca": 0.3, "ghosts": 0.0}


@pytest.fixture(autouse=True)
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crowds, "realism_by_name", REALISM.get)


def made(values: dict[str, dict[str, float]]) -> Results:
    """Crowd -> planner -> value of safe_efficiency, in three scenarios."""
    runs: list[RunRow] = []
    scores: list[ScoreRow] = []
    for crowd, planners in values.items():
        for planner, value in planners.items():
            for number in range(3):
                row = run(planner, f"s{number}+{crowd}", axes={"crowd": crowd})
                runs.append(row)
                scores.append(
                    score(row, value + 0.01 * number, metric="safe_efficiency", better="higher")
                )
    return Results(runs=tuple(runs), scores=tuple(scores))


def test_a_planted_swap_is_found() -> None:
    found = crowd_ranks(
        made({
            "calibrated": {"a": 0.9, "b": 0.5, "c": 0.1},
            "orca": {"a": 0.5, "b": 0.9, "c": 0.1},
            "power_law": {"a": 0.9, "b": 0.5, "c": 0.1},
        })
    )  # fmt: skip
    assert found is not None
    assert [o.crowd for o in found.orders] == ["calibrated", "orca", "power_law"]
    assert list(found.orders[1].means) == ["b", "a", "c"]
    assert found.taus["calibrated", "orca"] == pytest.approx(1.0 / 3.0)
    assert found.taus["calibrated", "power_law"] == pytest.approx(1.0)
    (swapped,) = [v for v in found.verdicts if v.against]
    assert (swapped.first, swapped.second) == ("a", "b")
    assert swapped.against == ("orca",)
    assert swapped.weighted == pytest.approx(0.75)  # 0.9 of 1.2; power_law was not measured
    assert "a before b in 2 of 3 crowds, 75 %" in swapped.text
    assert "the other way round in orca" in swapped.text
    assert found.as_json()["verdicts"][0]["crowds"] == 3


def test_ghosts_have_no_say_and_unknown_crowds_count_alike() -> None:
    found = crowd_ranks(made({"calibrated": {"a": 0.9, "b": 0.5}, "ghosts": {"a": 0.1, "b": 0.5}}))
    assert found is not None
    assert found.verdicts[0].weighted == pytest.approx(1.0)
    unknown = crowd_ranks(made({"x": {"a": 0.9, "b": 0.5}, "y": {"a": 0.8, "b": 0.5}}))
    assert unknown is not None
    assert unknown.verdicts[0].weighted == pytest.approx(1.0)
    assert unknown.verdicts[0].against == ()


def test_what_has_no_order_has_none() -> None:
    assert crowd_ranks(made({"orca": {"a": 0.9, "b": 0.5}})) is None
    assert crowd_ranks(made({"orca": {"a": 0.9}, "calibrated": {"a": 0.9}})) is None
    assert crowd_ranks(Results()) is None


def test_kendall_by_hand() -> None:
    assert kendall([1, 2, 3], [1, 2, 3]) == pytest.approx(1.0)
    assert kendall([1, 2, 3], [3, 2, 1]) == pytest.approx(-1.0)
    assert kendall([1, 2, 3], [1, 3, 2]) == pytest.approx(1.0 / 3.0)
    assert kendall([1, 1, 2], [1, 2, 3]) == pytest.approx(2.0 / math.sqrt(6.0))
    assert math.isnan(kendall([1, 1], [1, 2]))
