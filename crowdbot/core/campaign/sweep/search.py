"""The search of a sweep: trials on people of one seed; the best are checked on another."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from crowdbot.core.campaign.plan import Plan, make_plan
from crowdbot.core.campaign.request import CampaignRequest
from crowdbot.core.campaign.run import State
from crowdbot.core.campaign.sweep.axes import How, ParameterAxis, Trial, run_trials, trial_count
from crowdbot.core.planning.given_planner import choose_planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.results.results import Results
from crowdbot.core.scenarios.library import open_document, suite_names
from crowdbot.core.scoring.score_scale import score_scales
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.summary_estimator import planner_mean
from crowdbot.core.statistics.table import Table
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.support.text_files import read_text
from crowdbot.errors import InputError, UnknownNameError, UsageError

STATE, PAGE, RUNS = "sweep.json", "sweep.html", "runs"
_SEARCH, _CHECK = "search", "check"


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepRequest:
    """Arguments of a sweep: suite, planner, varied parameters, search method.

    Attributes:
        suite: file or name; its conditions are used, not its people.
        planner: name or file.
        axes: what is varied.
        how, count, steps: as in `run_trials`.
        seed: of the people of the search, and of random trials; the check uses the next seed.
        metric, variant, better: the score.
        only: patterns of scenarios; ``sample``: number of scenarios, chosen by chance.
        check: number of best trials that are tried on other people.
        out: folder of the sweep.
        settings: fixed ``key=value`` texts of the planner.
    """

    suite: str
    planner: str
    axes: tuple[ParameterAxis, ...]
    how: How
    count: int
    steps: int
    seed: int
    metric: str
    variant: str
    better: str
    only: Sequence[str]
    sample: int | None
    check: int
    out: Path
    settings: Sequence[str] = ()
    plugins: Sequence[Path] = ()

    @property
    def trials(self) -> int:
        """Return the number of trials, without that of the defaults."""
        return trial_count(self.axes, self.how, self.count, self.steps)

    @property
    def rounds(self) -> int:
        """Return how often the planner runs through all scenarios, checks included."""
        checks = min(self.check, self.trials)
        return self.trials + 1 + checks + bool(checks)

    @property
    def document(self) -> dict[str, Any]:
        """Return everything that determines the trials, as stored in the sweep's file."""
        plain = asdict(self)
        for name in ("out", "check", "plugins", "count"):  # more of the same is the same sweep
            del plain[name]
        return dict(json.loads(json.dumps(plain)))


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialResult:
    """One trial: its parameters, label, and score on the people of the search and others.

    ``motions`` are the hashes of its runs' trajectories: equal ones met the same people.
    """

    trial: Trial
    label: str
    score: Estimate
    runs: int
    elsewhere: Estimate | None = None
    motions: frozenset[str] = frozenset()
    motions_elsewhere: frozenset[str] = frozenset()

    @property
    def met_others(self) -> bool:
        """Return False if the check had the same people as the search, as with fixed positions."""
        return not self.motions or self.motions != self.motions_elsewhere


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """The result: trials sorted from best to worst, those without a score last.

    ``usual``: the result of the planner's defaults.
    """

    request: SweepRequest
    tried: tuple[TrialResult, ...]
    usual: TrialResult | None

    @property
    def best(self) -> TrialResult | None:
        """Return the best trial."""
        return next((t for t in self.tried if t.score.value is not None), None)


Execute = Callable[[Plan, str], State]


def search(request: SweepRequest, registry: Registry, execute: Execute) -> Sweep:
    """Run all trials, then the best ones on other people; runs that exist are skipped.

    Args:
        registry: the installed components.
        execute: function that executes a plan, given a title to show.

    Raises:
        InputError: the folder holds another sweep.
        CrowdbotError: suite, planner or a parameter is wrong.
    """
    _check_parameters(request, registry)
    _claim(request)
    rounds = {
        name: _Round(request, registry, execute, name, request.seed + i)
        for i, name in enumerate((_SEARCH, _CHECK))
    }
    found: dict[tuple[tuple[str, str], ...], TrialResult] = {}

    def score(trial: Trial) -> float | None:
        key = tuple(sorted(trial.items()))
        if key not in found:
            title = f"trial {len(found) + 1} of {request.trials}: {words(trial)}"
            found[key] = rounds[_SEARCH].run(trial, title)
        return found[key].score.value

    usual = rounds[_SEARCH].run({}, "the planner's defaults")
    for _ in run_trials(
        request.axes, request.how, request.count, request.seed, request.steps, score,
        request.better,
    ):  # fmt: skip
        _write(request, found.values())
    tried, again = _ordered(request, found.values()), rounds[_CHECK].again
    for i, one in enumerate(tried[: request.check]):
        title = f"check {i + 1} of {request.check} on other people: {words(one.trial)}"
        tried[i] = again(one, title)
    if request.check:
        usual = again(usual, "check of the defaults on other people")
    _write(request, tried)
    return Sweep(request=request, tried=tuple(tried), usual=usual)


def _ordered(request: SweepRequest, tried: Iterable[TrialResult]) -> list[TrialResult]:
    """Return trials from the best to the worst; those without a score are last."""
    sign = -1.0 if request.better == "higher" else 1.0
    return sorted(
        tried, key=lambda t: (t.score.value is None, sign * (t.score.value or 0.0), words(t.trial))
    )


def _check_parameters(request: SweepRequest, registry: Registry) -> None:
    """Check the values of each axis by itself, before anything runs.

    Raises:
        CrowdbotError: the planner has no such parameter, or it cannot have such a value.
    """
    for axis in request.axes:
        for value in axis.values or (axis.at(0.0), axis.at(1.0)):
            settings = [*request.settings, f"{axis.name}={value}"]
            choose_planner(request.planner, registry, settings)


def words(trial: Trial) -> str:
    """Return the parameters of a trial as text."""
    return " ".join(f"{name}={value}" for name, value in trial.items()) or "defaults"


class _Round:
    """Runs on the people of one seed."""

    def __init__(
        self, request: SweepRequest, registry: Registry, execute: Execute, name: str, seed: int
    ) -> None:
        self._request, self._registry, self._execute = request, registry, execute
        self._root = request.out / RUNS / name
        self._suite = _derived(request, registry, name, seed)
        self._scales = score_scales(registry)

    def run(self, trial: Trial, title: str) -> TrialResult:
        """Return the score of a trial, after running what is missing."""
        request = self._request
        settings = [*request.settings, *(f"{k}={v}" for k, v in trial.items())]
        plan = make_plan(
            CampaignRequest(
                suites=[str(self._suite)], planners=[request.planner], only=request.only,
                sample=request.sample, out=self._root, planner_settings=settings,
                plugins=request.plugins,
            ),
            self._registry,
        )  # fmt: skip
        if plan.jobs:
            self._execute(plan, title)
        (label,) = plan.labels
        places = {run.key for run in plan.runs}
        results = Results.open(self._root)
        kept = tuple(r for r in results.runs if r.run_id in places)
        table = Table(
            Results(runs=kept, scores=results.scores, failures=results.failures,
                    scales=self._scales)
        )  # fmt: skip
        name = (request.metric, request.variant)
        known = name in table.names and label in table.planners
        score = planner_mean(table, name, label) if known else Estimate(reason="not scored")
        motions = frozenset(run.trajectory_hash for run in kept)
        return TrialResult(
            trial=trial, label=label, score=score, runs=len(plan.runs), motions=motions
        )

    def again(self, tried: TrialResult, title: str) -> TrialResult:
        """Return a trial with its score on these people."""
        found = self.run(tried.trial, title)
        return replace(tried, elsewhere=found.score, motions_elsewhere=found.motions)


def _derived(request: SweepRequest, registry: Registry, name: str, seed: int) -> Path:
    """Write a suite with the same conditions and people of another seed.

    Raises:
        UsageError: the suite has this seed.
        InputError: it is a single scenario.
    """
    document = open_document(request.suite, registry)
    suite = document.suite
    if suite.seed is None:
        raise InputError(f"{document.name} is a single scenario; a sweep needs a suite")
    if suite.seed.value == seed:
        raise UsageError(f"--seed {request.seed}: seed {seed} has the people of {request.suite}")
    source = document.path.resolve()
    file = request.out / f"{name}.yaml"
    if request.suite in suite_names(registry):
        plugin, _, short = request.suite.rpartition(":")
        extends = f"{plugin or 'builtin'}:{short}.yaml"
    else:  # what a document extends lies beside it
        extends, file = source.name, source.with_name(f"{source.stem}-{name}-{seed}.yaml")
    title = f"{source.stem}: people of seed {seed}, for a sweep"
    text = (
        f"crowdbot: 1\nextends: {json.dumps(extends)}\n"
        f"suite: {{id: {source.stem}-{name}, title: {json.dumps(title)}, seed: {seed}}}\n"
    )
    atomic_write(file, text)
    return file


def _claim(request: SweepRequest) -> None:
    """Check that the folder is new, or holds this sweep.

    Raises:
        InputError: it holds another one.
    """
    file = request.out / STATE
    if not file.exists():
        _write(request, ())
        return
    try:
        there = parse_json(read_text(file))
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: is not the file of a sweep: {error}") from error
    known = there.get("request") if isinstance(there, dict) else None
    if known != request.document:
        old = known if isinstance(known, dict) else {}
        keys = [k for k, v in request.document.items() if old.get(k) != v]
        raise InputError(
            f"{request.out}: holds another sweep ({', '.join(keys)} differ); "
            "give another folder with --out"
        )


def _write(request: SweepRequest, tried: Any) -> None:
    rows = [_row(one) for one in tried]
    atomic_write(
        request.out / STATE,
        json.dumps({"request": request.document, "trials": rows}, indent=2) + "\n",
    )


def _row(one: TrialResult) -> Mapping[str, Any]:
    elsewhere = None if one.elsewhere is None else asdict(one.elsewhere)
    return {
        "parameters": dict(one.trial), "planner": one.label, "runs": one.runs,
        "score": asdict(one.score), "elsewhere": elsewhere,
    }  # fmt: skip


def rows_of(sweep: Sweep) -> list[Mapping[str, Any]]:
    """Return the trials as plain data, best first; the defaults last."""
    return [_row(one) for one in (*sweep.tried, *filter(None, [sweep.usual]))]


def known_metric(registry: Registry, metric: str) -> tuple[str, str]:
    """Return the variant that represents a metric, and its better direction.

    Raises:
        UnknownNameError: there is no such metric.
        UsageError: it has no direction.
    """
    metrics = registry.components("metric")
    if metric not in metrics:
        raise UnknownNameError("metric", metric, metrics)
    found: Any = metrics[metric]
    if found.better not in ("higher", "lower"):
        raise UsageError(f"--metric {metric}: neither higher nor lower values are better")
    names = list(found.variants)
    first = next((v for v in ("rate", "pace", "corrected") if v in names), names[0])
    return first, found.better
