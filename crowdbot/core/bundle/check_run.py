"""Check that record, scores and manifest of one bundled run are consistent."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from crowdbot.core.bundle.check_fleet import arrivals, fleet_problems
from crowdbot.core.bundle.manifest import BundledRun, Manifest
from crowdbot.core.planning.watchdog import STEP_LIMIT
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.fleet_scores import AT
from crowdbot.core.types.ending import Ending
from crowdbot.core.types.score import Score
from crowdbot.dsl.spec.metric_component import MetricComponent

#: Rounding tolerance of a score's bounds.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class ClaimedRun:
    """One run as contained in the bundle.

    Attributes:
        planners: names of the planner in its score rows.
    """

    entry: BundledRun
    record: RunRecord = field(repr=False)
    scores: tuple[Score, ...] = field(repr=False)
    planners: frozenset[str] = frozenset()

    @property
    def name(self) -> str:
        """Return a readable name."""
        return f"{self.entry.scenario} seed-{self.entry.seed}"


def run_problems(run: ClaimedRun, manifest: Manifest) -> Iterator[str]:
    """Yield contradictions between record, manifest and hashes."""
    yield from _identity_problems(run, manifest)
    yield from _ending_problems(run)
    yield from _excused_problems(run.record)
    yield from _score_problems(run, manifest)
    yield from fleet_problems(run.record, run.scores)


def declared_problems(run: ClaimedRun, registry: Registry) -> Iterator[str]:
    """Yield scores whose unit, direction, category or value contradicts their metric."""
    known = registry.components("metric")
    for score in run.scores:
        metric = known.get(score.metric)
        scored = run.record.metrics.get(score.metric)
        version = None if scored is None else scored.spec_version
        if not isinstance(metric, MetricComponent) or metric.spec_version != version:
            continue  # not comparable, which the comparison reports
        declared = metric.variants.get(score.variant.partition(AT)[0])
        if declared is None:
            yield f"{score.metric} has no variant '{score.variant[:60]}'"
            continue
        claimed = (score.symbol, score.category, score.unit, score.better)
        expected = (metric.symbol, metric.score_category, declared.unit, declared.better)
        if claimed != expected:
            yield f"{score.metric}.{score.variant} is {', '.join(claimed)} there, here " \
                  f"{', '.join(expected)}"  # fmt: skip
        low, high = declared.invariants.minimum, declared.invariants.maximum
        if score.value is not None and not low - _ROUNDING <= score.value <= high + _ROUNDING:
            yield f"{score.metric}.{score.variant} is {score.value:g}; it lies between " \
                  f"{low:g} and {high:g}"  # fmt: skip


def _identity_problems(run: ClaimedRun, manifest: Manifest) -> Iterator[str]:
    record, entry = run.record, run.entry
    single = manifest.edition.scenarios == 1
    if not record.run_id == record.id() == entry.run_id:
        yield f"its run_id is not the hash of what {files.RECORD} says"
    if record.hashes.trajectory != entry.trajectory:
        yield f"the trajectory's hash in {files.RECORD} is not that of the manifest"
    if (record.scenario, record.seed) != (entry.scenario, entry.seed):
        yield "its record is of another scenario or seed"
    if record.suite not in (manifest.edition.suite, *["scenarios"] * single):
        yield f"its record is of suite '{record.suite[:60]}'"
    if entry.directory != _directory(run, manifest):
        yield f"its folder should be {_directory(run, manifest)[:200]}"
    if record.planner.document() != manifest.planner:
        yield "its planner is not that of the manifest"
    if record.versions != manifest.versions:
        yield "its versions are not those of the manifest"
    budget = record.step_budget
    if budget is not None and not (type(budget) in (int, float) and 0.0 < budget < STEP_LIMIT):
        yield f"its step_budget is {str(budget)[:40]}; it lies between 0 and {STEP_LIMIT:g} s"
    if record.pinned != manifest.pinned:
        yield f"the manifest says pinned: {manifest.pinned}, the run does not"
    if record.classed != manifest.classed:
        yield f"the manifest says '{manifest.classed}', the run does not"


def _directory(run: ClaimedRun, manifest: Manifest) -> str:
    entry = run.entry
    return f"runs/{run.record.suite}/{entry.scenario}/{manifest.label}/seed-{entry.seed}"


def _ending_problems(run: ClaimedRun) -> Iterator[str]:
    """Yield contradictions between status, time of arrival and success."""
    record = run.record
    if record.status == Ending.ARRIVED and record.goal_time is None:
        yield "its status is 'arrived', but it has no time of arrival"
    alone = not record.robots
    for key in ("goal_time", "toppled_time"):
        time = getattr(record, key)
        if time is not None and time > record.sim_time:
            yield f"its {key} is {time:g} s, but it ended after {record.sim_time:g} s"
    if record.status != Ending.ARRIVED and alone and record.goal_time is not None:
        yield f"its status is '{record.status}', but it has a time of arrival"
    if record.status == Ending.TOPPLED and alone and record.toppled_time is None:
        yield "its status is 'toppled', but it has no toppled_time"
    arrived = arrivals(record)
    for score in run.scores:
        _, _, robot = score.variant.partition(AT)
        if (score.metric, score.status) != ("success", "ok") or robot not in arrived:
            continue
        if score.value != arrived[robot]:
            claim_name = f"success of {robot}" if robot else "success"
            yield f"its {claim_name} is {score.value:g}, which its time of arrival contradicts"


def _excused_problems(record: RunRecord) -> Iterator[str]:
    """Yield contradictions in the list of replaced draws."""
    excused, most = record.excused, record.replace_draws
    people = [e.realisation for e in excused]
    if len(excused) > most:
        yield f"{len(excused)} of its draws were replaced, but at most {most} may be"
    if [e.draw for e in excused] != list(range(len(excused))):
        yield "its replaced draws are not numbered from 0 on"
    if people[:1] not in ([], [record.hashes.realisation]):
        yield "the first of its replaced draws does not have the people of the scenario"
    if len(set(people)) < len(people):
        yield "two of its replaced draws have the same people"
    for one in excused:
        if one.trajectory == record.hashes.trajectory:
            yield "a draw that it says was replaced is the run itself"
        if one.struck_time > one.toppled_time:
            yield "in a replaced draw the robot toppled before it was struck"


def _score_problems(run: ClaimedRun, manifest: Manifest) -> Iterator[str]:
    times = Counter((s.metric, s.variant) for s in run.scores)
    for (metric, variant), count in times.items():
        if count > 1:
            yield f"{files.SCORES}: {metric}.{variant} is there {count} times"
    for planner in sorted(run.planners - {manifest.label}):
        yield f"{files.SCORES}: scores of another planner: '{planner[:60]}'"
    scored, versions = {s.metric for s in run.scores}, run.record.metrics.keys()
    for metric in sorted(scored - versions):
        yield f"{files.RECORD} does not say which version of {metric[:60]} was scored"
    for metric in sorted(versions - scored):
        yield f"{files.SCORES}: {metric[:60]} was scored, but is not there"
