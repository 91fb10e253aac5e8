"""Repeat a random sample of a bundle's runs."""

from __future__ import annotations

import json
import random
import tempfile
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.bundle.manifest import Manifest
from crowdbot.core.bundle.rerun_verdict import Rerun
from crowdbot.core.planning.choice import ANYWHERE, PlannerPlace
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import prepare
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.runs.read_and_score import score_robots
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scoring.metric import References
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.sim.simulate import make_run
from crowdbot.core.types.score import Score
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.dsl.suite.expand import Expansion
from crowdbot.errors import InputError

#: Keys of a planner in run.json that are not parameters.
_NAMES = ("kind", "name", "label")


class NotRunnable(InputError):  # noqa: N818 - an outcome of verification
    """The planner of a bundle is missing or different here."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RerunSetup:
    """The setup for repeating runs.

    Attributes:
        choice: the planner, from `choose_planner`.
        progress, stop, on_hang: as in `Request`.
    """

    expansion: Expansion
    registry: Registry
    choice: PlannerChoice
    progress: Callable[[Progress], None] | None = None
    stop: Callable[[], bool] = lambda: False
    on_hang: Callable[[], object] | None = None


def choose_planner(
    manifest: Manifest, registry: Registry, given: str | None, place: PlannerPlace = ANYWHERE
) -> PlannerChoice:
    """Return the planner that a bundle was made with.

    Args:
        manifest: manifest of the bundle.
        registry: the installed components.
        given: replacement for the kind in the bundle: ``file.py:Class``, or the document of a
            program.
        place: where it runs.

    Raises:
        NotRunnable: it is missing, or differs from the one that made the bundle.
    """
    record = manifest.planner
    kind, digest = str(record.get("kind", "")), record.get("sha256")
    if given is None and digest is not None:
        raise NotRunnable(
            f"the planner is the class {kind} of a file that is not installed; get the file from "
            "the team and name it: --source FILE.py:CLASS"
        )
    try:
        text, settings = _named(record)
        choice = resolve_planner(given or text, registry, settings, place)
    except InputError as error:
        raise NotRunnable(
            f"{error}; install the planner, load it with --plugin DIR, or name its class with "
            "--source FILE.py:CLASS"
        ) from None
    if digest is not None and choice.spec_dump.get("sha256") != digest:
        raise NotRunnable(
            f"{given} is not the file that the bundle was made with (sha256 {digest})"
        )
    if digest is not None and _class(choice.spec_dump) != _class(record):
        raise NotRunnable(
            f"{given} is not the class that the bundle was made with: {_class(record)}"
        )
    if _parameters(json.loads(json.dumps(choice.spec_dump))) != _parameters(record):
        raise NotRunnable(
            f"planner '{choice.label}' has other parameters here than in the bundle, "
            f"where it is called '{manifest.label}'; install the version of the team"
        )
    return choice


def draw_sample(runs: Sequence[ClaimedRun], size: int | None, seed: int, content: str) -> list[int]:
    """Return the indices of the runs to repeat; all of them if ``size`` is None.

    Args:
        runs: runs of the bundle.
        size: number of runs.
        seed: chosen by the verifier; a team that knows it in advance knows the sample.
        content: hash of the bundle, so that it cannot be changed without changing the sample.
    """
    if size is None or size >= len(runs):
        return list(range(len(runs)))
    rng = random.Random(stream_seed(seed, content, "verify.sample"))
    return sorted(rng.sample(range(len(runs)), size))


def make_rerun(setup: RerunSetup, claimed: ClaimedRun) -> Rerun:
    """Simulate and score one run of a bundle.

    If the trajectory differs without a reason, the run is repeated once more, to check if the
    planner is deterministic.

    Raises:
        CrowdbotError: it cannot be simulated.
    """
    first = _simulate(setup, claimed)
    if first.relation != "different":
        return first
    return replace(first, repeated=_simulate(setup, claimed).trajectory)


def _simulate(setup: RerunSetup, claimed: ClaimedRun) -> Rerun:
    scenario = next(s for s in setup.expansion.scenarios if s.id == claimed.entry.scenario)
    compared = bool(claimed.record.references)
    with tempfile.TemporaryDirectory(prefix="crowdbot-verify-") as folder:
        request = Request(
            scenario=scenario,
            choice=setup.choice,
            registry=setup.registry,
            seed=claimed.entry.seed,
            out=Path(folder),
            entry=setup.expansion.entry(scenario),
            options=RunOptions(
                record="none",
                replay=False,
                references=compared,
                metrics=setup.expansion.metrics,
                step_budget=claimed.record.step_budget,
            ),
            progress=setup.progress,
            stop=setup.stop,
            on_hang=setup.on_hang,
        )
        run = make_run(request, prepare(scenario, setup.registry, references=compared))
        rows = read_scores_csv(run.directory / files.SCORES)
        rerun = Rerun(claimed=claimed, record=run.record, scores=tuple(row.score for row in rows))
        if rerun.relation != "identical" or rerun.same_platform:
            return rerun
        return replace(rerun, own=_own_scores(setup, run, rerun.scores))


def _own_scores(setup: RerunSetup, run: Run, scores: Sequence[Score]) -> frozenset[tuple[str, str]]:
    """Return scores independent of calibration runs, which may differ on this processor."""
    metrics = "*" if setup.expansion.metrics is None else setup.expansion.metrics
    without = {
        (s.metric, s.variant): (s.status, s.value, s.lower, s.upper)
        for s in score_robots(
            setup.registry,
            run.robots or {"robot": run.trajectories},
            defaultdict(References),
            metrics=metrics,
        )
    }
    return frozenset(
        (s.metric, s.variant)
        for s in scores
        if without.get((s.metric, s.variant)) == (s.status, s.value, s.lower, s.upper)
    )


def _class(record: Mapping[str, Any]) -> str:
    """Return the class name of a planner from a file."""
    return str(record.get("kind", "")).rpartition(":")[2]


def _named(record: Mapping[str, Any]) -> tuple[str, list[str]]:
    """Return a planner and settings as arguments of `resolve_planner`, also for several robots."""
    robots = record.get("robots")
    if record.get("kind") != "fleet" or not isinstance(robots, Mapping):
        return str(record.get("kind", "")), _settings(record)
    text = ",".join(f"{name}={one.get('kind', '')}" for name, one in robots.items())
    return text, [f"{name}.{s}" for name, one in robots.items() for s in _settings(one)]


def _settings(record: Mapping[str, Any]) -> list[str]:
    """Return parameters as texts for `resolve_planner`; JSON is valid YAML."""
    return [f"{k}={json.dumps(v)}" for k, v in _parameters(record).items()]


def _parameters(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the planner's parameters; those of a class in a file are separate."""
    if "sha256" in record:
        return dict(record.get("parameters") or {})
    return {k: v for k, v in record.items() if k not in _NAMES}
