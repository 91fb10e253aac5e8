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
from crowdbot.core.bundle.check_planner import planner_problems
from crowdbot.core.bundle.manifest import Manifest
from crowdbot.core.bundle.rerun_verdict import Rerun
from crowdbot.core.planning.choice import ANYWHERE, PlannerPlace
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner
from crowdbot.core.registry.plugin import BUILTIN
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import prepare
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.runs.read_and_score import score_robots
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.core.scenarios.fresh_draws import fresh_draws
from crowdbot.core.scoring.metric import References
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.sim.simulate import make_run
from crowdbot.core.types.score import Score
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError

#: Keys of a planner in run.json that are not parameters.
_NAMES = ("kind", "name", "label")


class NotRunnable(InputError):  # noqa: N818 - an outcome of verification
    """The planner of a bundle is not installed, or differs from the one in the bundle."""


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
        place: where the planner runs.

    Raises:
        NotRunnable: it is missing, or differs from the one that made the bundle.
    """
    record = manifest.planner
    kind, digest = str(record.get("kind", "")), record.get("sha256")
    if problems := list(planner_problems(record)):
        raise NotRunnable(problems[0])
    if given is None and digest is not None:
        raise NotRunnable(
            f"the planner is the class {kind} of a file that is not installed; name it, or "
            "what the team sealed: --source FILE.py:CLASS or FILE.cbs"
        )
    try:
        text, settings = _named(record)
        choice = resolve_planner(given or text, registry, settings, place)
    except InputError as error:
        raise NotRunnable(
            f"{error}; install the planner, load it with --plugin DIR, or name it with "
            "--source FILE.py:CLASS or FILE.cbs"
        ) from None
    if digest is not None and choice.spec_dump.get("sha256") != digest:
        raise NotRunnable(
            f"{given} is not the file that the bundle was made with (sha256 {digest})"
        )
    if digest is not None and _class(choice.spec_dump) != _class(record):
        raise NotRunnable(
            f"{given} is not the class that the bundle was made with: {_class(record)}"
        )
    if bool(choice.spec_dump.get("network")) != bool(record.get("network")):
        raise NotRunnable(f"{given} asks for the network, and the bundle does not, or conversely")
    if _parameters(json.loads(json.dumps(choice.spec_dump))) != _parameters(record):
        raise NotRunnable(
            f"planner '{choice.label}' has other parameters here than in the bundle, "
            f"where it is called '{manifest.label}'; install the version of the team"
        )
    if choice.label != manifest.label:
        raise NotRunnable(f"the bundle calls its planner '{manifest.label}'; it is {choice.label}")
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


def foreign_owners(manifest: Manifest, registry: Registry) -> dict[str, str]:
    """Return plugins that provide the planner and are loaded into the simulator: name -> origin.

    Such a plugin can change what the simulator computes, in its own favour.
    """
    robots = manifest.planner.get("robots")
    parts = [manifest.planner, *(robots.values() if isinstance(robots, Mapping) else ())]
    known = registry.components("planner")
    owners = [registry.owner(known[k]) for p in parts if (k := str(p.get("kind", ""))) in known]
    return {o.name: o.origin for o in owners if o.name != BUILTIN}


def make_reruns(setup: RerunSetup, chosen: Sequence[ClaimedRun]) -> list[Rerun]:
    """Simulate and score some runs of a bundle.

    A run whose trajectory differs is repeated once more, to detect nondeterministic planners; where
    the claimed processor or software differs, only the first such run.

    Raises:
        CrowdbotError: one cannot be simulated.
    """
    reruns: list[Rerun] = []
    for claimed in chosen:
        rerun = _simulate(setup, claimed)
        elsewhere = rerun.relation == "different_platform"
        known = any(r.repeated is not None for r in reruns)
        if rerun.relation == "different" or (elsewhere and not known):
            rerun = replace(rerun, repeated=_simulate(setup, claimed).trajectory)
        reruns.append(rerun)
    return reruns


def make_fresh(
    setup: RerunSetup, suite: str, runs: Sequence[ClaimedRun], count: int, seed: int
) -> list[Rerun]:
    """Simulate and score scenarios of a bundle with new people.

    Args:
        setup: as for the bundle's own runs.
        suite: file or name of the suite.
        runs: runs of the bundle.
        count: number of runs; those of the bundle are taken several times if it has fewer.
        seed: chosen by the verifier after the planner was handed in.

    Raises:
        InputError: the suite's people do not depend on a seed.
        CrowdbotError: a run cannot be simulated.
    """
    reruns: list[Rerun] = []
    order = random.Random(stream_seed(seed, "order", "verify.fresh")).sample(runs, len(runs))
    for start in range(0, count, len(runs)):
        root = stream_seed(seed, str(start), "verify.people") % 2**63
        own = replace(setup, expansion=fresh_draws(suite, setup.registry, root))
        reruns += [_simulate(own, run) for run in order[: count - start]]
    people = [(f.record.hashes.realisation, f.claimed.record.hashes.realisation) for f in reruns]
    if people and all(a == b for a, b in people):
        raise InputError(f"{suite}: the people of its scenarios do not depend on the seed")
    return reruns


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
                replace_draws=claimed.record.replace_draws,
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
