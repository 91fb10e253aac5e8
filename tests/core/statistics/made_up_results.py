"""Results of campaigns that never were."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from tests.core.results.made_up_record import made_up_record

AXES = {
    "flow": ("in", "counter"),
    "density": ("d0125", "d0250", "d0500"),
    "speed": ("slow", "fast", "dispersed"),
    "coeff": ("c01", "c20", "c50"),
    "range": ("r02", "r05", "r10"),
}
#: Axes whose labels share a crowd draw.
SHARED = ("coeff", "range")


def run(planner: str = "a", scenario: str = "s0", draw: str = "d0", seed: int = 0,
        **more: Any) -> RunRow:  # fmt: skip
    directory, given = more.pop("directory", ""), more.pop("record", {})
    values: dict[str, Any] = {
        "run_id": f"{planner}/{scenario}/{seed}", "scenario": scenario, "seed": seed,
        "spec_hash": f"spec-{scenario}", "realisation_hash": draw, **given,
        "planner": {**given.get("planner", {}), "label": planner}, **more,
    }  # fmt: skip
    return RunRow(record=made_up_record(**values), directory=directory)


def score(of: RunRow, value: float | None = None, **more: Any) -> ScoreRow:
    values: dict[str, Any] = {
        "run_id": of.run_id, "category": "task", "metric": "m", "symbol": "M",
        "variant": "corrected", "value": value, "unit": "s", "better": "higher",
        "status": "undefined" if value is None else "ok", "reason": "", "lower": None,
        "upper": None, **more,
    }  # fmt: skip
    return ScoreRow(**values)


def censored(of: RunRow, lower: float | None = None, upper: float | None = None,
             **more: Any) -> ScoreRow:  # fmt: skip
    return score(of, status="censored", reason="goal_not_reached", lower=lower, upper=upper, **more)


def pairs(a: Sequence[float], b: Sequence[float], draws: Sequence[str] | None = None,
          better: str = "higher", **more: Any) -> Results:  # fmt: skip
    """Two planners with one score; each pair has a draw of its own unless others are given."""
    runs, scores = [], []
    for planner, values in (("a", a), ("b", b)):
        for i, value in enumerate(values):
            draw = f"d{i}" if draws is None else draws[i]
            runs.append(run(planner, f"s{i}", draw))
            scores.append(score(runs[-1], value, better=better, **more))
    return Results(runs=tuple(runs), scores=tuple(scores))


def cells() -> Iterator[tuple[str, str, dict[str, str]]]:
    """Scenario, draw and axes of the challenge's 162 scenarios."""
    for labels in product(*AXES.values()):
        axes = dict(zip(AXES, labels, strict=True))
        draw = "-".join(v for k, v in axes.items() if k not in SHARED)
        yield "-".join(labels), draw, axes


def challenge(
    planners: Sequence[str],
    metrics: int,
    rng: np.random.Generator,
    shift: Callable[[str], float] = lambda _: 0.0,
    spread: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> Results:
    """A whole campaign: effects of draws, of scenarios and of the run, different by planner."""
    runs, scores = [], []
    for planner in planners:
        by_draw: dict[str, np.ndarray[Any, Any]] = {}
        for scenario, draw, axes in cells():
            density = 0.001 * float(axes["density"][1:]) / 4
            runs.append(run(planner, scenario, draw, axes=axes, density=density))
            common = by_draw.setdefault(draw, spread[0] * rng.normal(size=metrics))
            values = common + spread[1] * rng.normal(size=metrics)
            values = values + spread[2] * rng.normal(size=metrics) + shift(planner)
            scores += [score(runs[-1], float(v), metric=f"m{k:02d}") for k, v in enumerate(values)]
    return Results(runs=tuple(runs), scores=tuple(scores))
