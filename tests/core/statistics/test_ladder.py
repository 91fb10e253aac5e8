"""The ladder of sensing: rungs in order, gains between them, and planners that are not on it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.ladder import Ladder, ladders
from tests.core.statistics.made_up_results import run, score

LOW = {"tracks": "lidar", "localisation": "corrected"}
HIGH = {"tracks": "truth", "localisation": "truth"}
USUAL = {"tracks": "tracker", "localisation": "corrected"}


def results(**values: tuple[dict[str, Any], list[float]]) -> Results:
    """Return runs of planners by label: parameters, and the score in each scenario."""
    runs, scores = [], []
    for label, (parameters, made) in values.items():
        for i, value in enumerate(made):
            planner = {"kind": "orca", "name": label, **parameters}
            runs.append(run(label, f"s{i}", f"d{i}", record={"planner": planner}))
            scores.append(score(runs[-1], value, metric="safe_efficiency"))
    return Results(runs=tuple(runs), scores=tuple(scores))


def only(found: tuple[Ladder, ...]) -> Ladder:
    (ladder,) = found
    return ladder


def test_rungs_go_from_the_least_knowledge_to_the_truth() -> None:
    ladder = only(
        ladders(
            results(
                top=(HIGH, [0.9, 0.8, 0.9]),
                low=(LOW, [0.3, 0.5, 0.4]),
                mid=(USUAL, [0.7, 0.6, 0.5]),
            )
        )
    )
    assert [r.name for r in ladder.rungs] == [
        "lidar / corrected", "tracker / corrected", "truth / truth",
    ]  # fmt: skip
    assert [r.runs for r in ladder.rungs] == [3, 3, 3]
    assert ladder.rungs[0].gain is None
    gains = [r.gain.by.value for r in ladder.rungs[1:] if r.gain is not None]
    assert gains == pytest.approx([0.2, 0.8 / 3])
    assert ladder.climb.by.value == pytest.approx(1.4 / 3)
    heights = [p["y"] for p in ladder.plot]
    assert heights == sorted(heights, reverse=True)  # px go down


def test_gains_are_over_common_runs_only() -> None:
    ladder = only(ladders(results(low=(LOW, [0.3, 0.5]), top=(HIGH, [0.5, 0.7, 0.0]))))
    assert ladder.climb.pairs == 2
    assert ladder.climb.by.value == pytest.approx(0.2)
    assert [r.runs for r in ladder.rungs] == [2, 3]


def test_planners_with_other_parameters_are_on_ladders_of_their_own() -> None:
    fast, slow = {"speed": 1.0}, {"speed": 0.5}
    found = ladders(
        results(
            a=({**LOW, **fast}, [0.1, 0.2]), b=({**HIGH, **fast}, [0.3, 0.4]),
            c=({**LOW, **slow}, [0.5, 0.6]),
        )
    )  # fmt: skip
    assert [r.planner for r in only(found).rungs] == ["a", "b"]


def test_one_rung_or_a_planner_without_rungs_is_no_ladder() -> None:
    assert ladders(results(a=(LOW, [0.1, 0.2]), b=({}, [0.3, 0.4]))) == ()


def test_a_field_of_the_same_name_with_another_meaning_is_no_rung() -> None:
    mine = {"tracks": "a.json", "localisation": "gps"}
    assert ladders(results(a=(mine, [0.1]), b=(HIGH, [0.2]))) == ()


def test_without_the_score_there_is_no_ladder() -> None:
    found = results(low=(LOW, [0.3]), top=(HIGH, [0.5]))
    other = tuple(replace(s, metric="m") for s in found.scores)
    assert ladders(replace(found, scores=other)) == ()
