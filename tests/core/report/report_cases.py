"""Made-up results of campaigns: every metric that is installed, drawn from named streams."""

from __future__ import annotations

import pickle
import zlib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.report.contents import Contents, Heading, gather
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, ScoreRow
from crowdbot.core.scoring.score_factory import ScoreFactory
from crowdbot.plugin import MetricComponent
from tests.core.results.made_up_record import made_up_record
from tests.once import once

AXES = {
    "flow": ("in", "counter"),
    "density": ("d0125", "d0250", "d0500"),
    "speed": ("slow", "fast", "dispersed"),
    "coeff": ("c01", "c20", "c50"),
    "range": ("r02", "r05", "r10"),
}
DRAWN = ("flow", "density", "speed")
#: How good each made-up planner is; the second differs from the first by nothing but noise.
SKILL = {"dwa": 0.0, "orca_lookahead": 0.0, "straight_on": -0.9}
_PEOPLE = {"d0125": 0.125, "d0250": 0.25, "d0500": 0.5}
_NO_DATA = {"shared control": "no_command", "questionnaire": "no_answers"}


def campaign(
    planners: Mapping[str, float] = SKILL,
    axes: Mapping[str, Sequence[str]] = AXES,
    seeds: int = 1,
    metrics: Sequence[str] | None = None,
    failures: int = 2,
    suite: str = "challenge-2020",
) -> Results:
    """Every scenario of the axes x planner x seed, with all metrics that are not experimental.

    The last ``failures`` runs of the last planner are failures of the campaign.
    """
    scored = _metrics(metrics)
    runs: list[RunRow] = []
    scores: list[ScoreRow] = []
    failed: list[Failure] = []
    cells = list(product(product(*axes.values()), planners, range(seeds)))
    last = [c for c in cells if c[1] == list(planners)[-1]]
    doomed = last[len(last) - failures :]
    for labels, planner, seed in cells:
        named = dict(zip(axes, labels, strict=True))
        if (labels, planner, seed) in doomed:
            failed.append(_failure(suite, named, planner, seed))
            continue
        run = _run(suite, named, planner, seed, planners[planner])
        runs.append(run)
        scores += _scores(run, scored, planners[planner])
    return Results(runs=tuple(runs), scores=tuple(scores), failures=tuple(failed))


def _failure(suite: str, named: dict[str, str], planner: str, seed: int) -> Failure:
    return Failure(
        suite=suite,
        scenario="-".join(named.values()),
        planner=planner,
        seed=seed,
        axes=named,
        error="MemoryError: 2 GiB are not enough",
        traceback='Traceback (most recent call last):\n  File "worker.py", line 12, in work\n'
        "MemoryError: 2 GiB are not enough\n",
    )


#: Of this worker; see `conftest.py`.
FACTORY: list[pytest.TempPathFactory] = []


@cache
def full() -> Contents:
    """Three planners x 162 scenarios, all metrics; one worker gathers them, in 20 s."""

    def make(folder: Path) -> None:
        (folder / "contents").write_bytes(pickle.dumps(contents(campaign())))

    folder = once(FACTORY[0], "report", make)
    found: Contents = pickle.loads((folder / "contents").read_bytes())  # noqa: S301
    return found


def contents(results: Results, **heading: Any) -> Contents:
    """A report about some results, with the cards that are installed."""
    links = {r.run_id: f"runs/{quote(r.directory)}/replay.html" for r in results.runs}
    return gather(results, discover(), Heading(suite="challenge-2020", **heading), links)


def stream(*names: object) -> np.random.Generator:
    """Random numbers of a name."""
    return np.random.default_rng(zlib.crc32("/".join(map(str, names)).encode()))


def _metrics(names: Sequence[str] | None) -> list[MetricComponent[Any]]:
    known = discover().components("metric")
    return [
        c
        for name, c in sorted(known.items())
        if isinstance(c, MetricComponent)
        and (name in names if names is not None else not (c.experimental or c.about_person))
    ]


def _run(suite: str, named: dict[str, str], planner: str, seed: int, skill: float) -> RunRow:
    scenario = "-".join(named.values())
    rng = stream("run", scenario, planner, seed)
    lateness = rng.normal(-skill - 2.4, 1.0)
    status = "timeout" if lateness > 0 else "arrived"
    if rng.random() < 0.006 * (1 - 3 * skill):
        status = "planner_failed"
    elif status == "timeout" and rng.random() < 0.1:
        status = "toppled"
    goal_time = float(np.exp(rng.normal(4.1 - 0.2 * skill, 0.15))) if status == "arrived" else None
    drawn = "-".join(named[a] for a in DRAWN if a in named)
    sim_time = goal_time or (180.0 if status == "timeout" else float(rng.uniform(5, 60)))
    reasons = {
        "arrived": "the robot reached its goal",
        "timeout": "180 s are over",
        "toppled": "toppled",
        "planner_failed": "step: ZeroDivisionError: float division by zero",
    }
    values: dict[str, Any] = {
        **record(planner),
        "run_id": f"cb1-sha256:{zlib.crc32(f'{scenario}/{planner}/{seed}'.encode()):064x}",
        "suite": suite,
        "scenario": scenario,
        "seed": seed,
        "axes": named,
        "status": status,
        "reason": reasons[status],
        "goal_time": goal_time,
        "sim_time": sim_time,
        "wall_time": float(rng.uniform(4, 12)),
        "privileged": planner.endswith("+privileged"),
        "spec_hash": f"cb1-sha256:{zlib.crc32(scenario.encode()):064x}",
        "realisation_hash": f"cb1-sha256:{zlib.crc32(drawn.encode()):064x}",
        "trajectory_hash": f"cb1-sha256:{zlib.crc32(f'{scenario}{planner}{seed}t'.encode()):064x}",
        "density": _PEOPLE.get(named.get("density", ""), 0.2) * float(rng.normal(1.0, 0.02)),
        "conditions": conditions(),
        "axis_words": words(named),
        "worst_moment": moment(rng),
    }
    directory = f"{suite}/{scenario}/{planner}/seed-{seed}"
    return RunRow(record=made_up_record(**values), directory=directory)


def words(named: Mapping[str, str]) -> dict[str, list[str]]:
    """Of the axis ``coeff`` only: the others have no words."""
    label = named.get("coeff", "")
    return {"coeff": ["ttca_dca weight", str(int(label[1:]))]} if label else {}


def moment(rng: np.random.Generator) -> dict[str, Any]:
    """When a run is worst."""
    clearance = round(float(rng.normal(0.2, 0.1)), 3)
    what = "least clearance" if clearance > 0 else "contact at fault"
    return {"t": round(float(rng.uniform(1, 60)), 3), "what": what, "clearance": clearance}


def conditions(**changed: str) -> dict[str, str]:
    """What all runs have in common."""
    return {"rates.log": "16 Hz", **changed}


def record(planner: str) -> dict[str, Any]:
    """The parts of a ``run.json`` that a report shows."""
    return {
        "planner": {"kind": planner, "name": planner, "label": planner, "lookahead": 1.5},
        "versions": {"python": "3.11.7", "crowdbot": "0.1.0", "drake": "1.51.1", "numpy": "2.4.6"},
        "plugins": [{"name": "builtin", "distribution": "crowdbot 0.1.0", "pinned": True}],
        "machine": {"system": "Linux", "machine": "x86_64"},
    }


def _scores(
    run: RunRow, metrics: Sequence[MetricComponent[Any]], skill: float
) -> Iterator[ScoreRow]:
    drawn = stream("crowd", run.realisation_hash)
    shared = drawn.normal(0.0, 0.25)  # what all runs in one crowd have in common
    rng = stream("scores", run.scenario, run.planner, run.seed)
    for metric in metrics:
        for variant in metric.variants:
            yield _score(run, metric, variant, shared + skill * 0.4 + rng.normal(0.0, 0.3), rng)


def _score(
    run: RunRow,
    metric: MetricComponent[Any],
    variant: str,
    quality: float,
    rng: np.random.Generator,
) -> ScoreRow:
    factory = ScoreFactory(metric)
    score = factory.ok(variant, _value(metric, variant, quality, run))
    if metric.score_category in _NO_DATA:
        score = factory.undefined(variant, _NO_DATA[metric.score_category])
    elif metric.kind.startswith("relative_") and run.status != "arrived":
        score = factory.censored(variant, "goal_not_reached", upper=score.value)
    elif metric.kind == "effect_on_time" and variant == "corrected" and rng.random() < 0.3:
        score = factory.censored(variant, "unfinished_trips", lower=score.value)
    elif metric.kind.startswith("neighbour") and rng.random() < 0.04:
        score = factory.undefined(variant, "no_neighbours")
    names = ("metric", "symbol", "category", "unit", "better", "variant", "status", "reason")
    numbers = ("value", "lower", "upper")
    fields: dict[str, Any] = {n: getattr(score, n) for n in (*names, *numbers)}
    return ScoreRow(run_id=run.run_id, **fields)


def _value(metric: MetricComponent[Any], variant: str, quality: float, run: RunRow) -> float:
    if metric.kind in ("success", "success_no_collision"):
        return float(run.status == "arrived")
    sign = {"higher": 1.0, "lower": -1.0}.get(metric.variants[variant].better, 0.5)
    scale = {"1": 1.0, "s": 6.0, "J": 30.0, "N": 400.0, "m": 2.0}.get(metric.unit, 3.0)
    value = scale * float(np.exp(sign * quality - 0.3))
    if metric.kind.endswith("_count"):
        return float(round(value))
    return min(value, 1.0) if metric.kind.endswith(("_fraction", "compliance", "spl")) else value
