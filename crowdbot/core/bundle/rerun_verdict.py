"""The verdict on a bundle after rerunning runs: comparison only, no simulation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from crowdbot.core.bundle.agreement import agree, name_of, shown
from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.bundle.tolerances import (
    SPREADS,
    WALL_CLOCK,
    are_equal,
    mean_limit,
    single_limit,
    variant_of,
)
from crowdbot.core.runs.record_parts import MetricPart
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.types.score import Score

Outcome = Literal[
    "verified",
    "within tolerance",
    "untrusted plugin",
    "nondeterministic",
    "worse on new people",
    "not comparable",
    "suspicious",
    "cannot be re-run",
    "invalid",
    "not re-run",
]
#: Verdicts with which a bundle is accepted.
FINE: tuple[Outcome, ...] = ("verified", "within tolerance", "not re-run")

#: Relation of a repeated run to the claim of the bundle.
#:
#: ``identical``: the trajectory is the same, bit by bit.
#: ``different``: it is not the same, although processor and software are.
#: ``different_platform``: it is not the same, but the processor or the software is not either.
#: ``nondeterministic``: not even two runs on this machine are the same.
Relation = Literal["identical", "different", "different_platform", "nondeterministic"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rerun:
    """A claimed run of a bundle, and the same run simulated here.

    Attributes:
        record: record of the new run.
        repeated: hash of the trajectory of a second rerun; None if there was none.
        own: scores that depend on no calibration run, if these may differ; None: not determined.
    """

    claimed: ClaimedRun
    record: RunRecord = field(repr=False)
    scores: tuple[Score, ...] = field(repr=False)
    repeated: str | None = None
    own: frozenset[tuple[str, str]] | None = None

    @property
    def trajectory(self) -> str:
        """Return the hash of the new trajectory."""
        return self.record.hashes.trajectory

    @property
    def relation(self) -> Relation:
        """Return the relation of both trajectories."""
        if self.trajectory == self.claimed.entry.trajectory:
            return "identical"
        if self.repeated is not None and self.repeated != self.trajectory:
            return "nondeterministic"
        return "different" if self.same_platform else "different_platform"

    @property
    def same_platform(self) -> bool:
        """Return True if processor and software are equal, so that trajectories must be too."""
        return same_platform(self.claimed.record, self.record)


@dataclass(frozen=True, slots=True, kw_only=True)
class RerunVerdict:
    """The outcome, and its reasons: one line per finding.

    Attributes:
        not_comparable: metrics whose version or parameters differ from those here.
        fresh: one line per main score on new people, with `verify --fresh-draws`.
        not_compared: scores for which runs that differ have no tolerance.
    """

    outcome: Outcome
    findings: tuple[str, ...] = ()
    relations: Mapping[str, Relation] = field(default_factory=dict)
    not_comparable: tuple[str, ...] = ()
    not_compared: tuple[str, ...] = ()
    fresh: tuple[str, ...] = ()


def verdict_of(reruns: Sequence[Rerun]) -> RerunVerdict:
    """Return the verdict on a bundle from its reruns."""
    relations = {a.claimed.name: a.relation for a in reruns}
    findings = [
        f"{a.claimed.name}: the trajectory is another one on the same processor "
        f"({a.record.machine.get('processor', '')}) with the same software"
        for a in reruns
        if a.relation == "different"
    ]
    for rerun in reruns:
        findings += _other_people(rerun)
        findings += _other_conditions(rerun)
        findings += _other_role(rerun)
        if rerun.relation == "identical":
            findings += _other_ending(rerun)
            findings += _unequal(rerun)
    others = [a for a in reruns if a.relation != "identical" or not a.same_platform]
    findings += _beyond(others)
    apart = _not_comparable(reruns)
    outcome: Outcome = "within tolerance" if others else "verified"
    if all(r == "identical" for r in relations.values()):
        outcome = "verified"
    if apart:
        outcome = "not comparable"
    if "nondeterministic" in relations.values():
        outcome = "nondeterministic"
    if findings:
        outcome = "suspicious"
    return RerunVerdict(
        outcome=outcome,
        findings=(*findings, *apart.values()),
        relations=relations,
        not_comparable=tuple(apart),
        not_compared=tuple(_not_compared([a for a in reruns if a.relation != "identical"])),
    )


def _not_compared(others: Sequence[Rerun]) -> list[str]:
    """Return the names of scores that have no tolerance for comparing different runs."""
    found = {(s.metric, s.variant) for a in others for s in a.claimed.scores}
    left = sorted((m, v) for m, v in found if m not in WALL_CLOCK and v != variant_of(m))
    return [f"{metric}.{variant}" for metric, variant in left]


def same_platform(claimed: RunRecord, record: RunRecord) -> bool:
    """True if two records come from the same processor and software."""
    a, b = claimed.machine, record.machine
    same = all(a.get(n, "") == b.get(n, "") != "" for n in ("processor", "rounding"))
    return same and claimed.versions == record.versions


# ----------------------------------------------------------------------------- records
#: Keys of run.json that follow from the trajectory and the planner.
_ENDING = (
    "status", "goal_time", "toppled_time", "sim_time", "density", "privileged", "clamped_commands",
    "excused",
)  # fmt: skip
#: Keys that follow from the trajectory to the last digit, on one platform only.
_TO_THE_DIGIT = ("reference_hashes", "worst_moment")
#: Keys that follow from the suite.
_OF_SUITE = ("axis_words", "suite_metrics", "crowd")


def _other_ending(rerun: Rerun) -> Iterator[str]:
    """Yield claims of the record that the equal trajectory contradicts."""
    claimed, here = rerun.claimed.record.document(), rerun.record.document()
    for key in _ENDING:
        claim, found = claimed.get(key), here.get(key)
        numbers = [x for x in (claim, found) if isinstance(x, float)]
        equal = are_equal(*numbers) if len(numbers) == 2 else claim == found
        if not equal:
            yield f"{rerun.claimed.name}: {key} is claimed to be {claim!r}, but is {found!r}"
    for key in _TO_THE_DIGIT if rerun.same_platform else ():
        if claimed.get(key) != here.get(key):
            yield f"{rerun.claimed.name}: {key} does not follow from the run"


def _other_people(rerun: Rerun) -> Iterator[str]:
    """Yield a problem if the claimed people are not those of the scenario, without a lock.

    Another platform may sample other people, and then the trajectory differs, too.
    """
    claim, found = (r.hashes.realisation for r in (rerun.claimed.record, rerun.record))
    if claim != found and (rerun.same_platform or rerun.relation == "identical"):
        yield (
            f"{rerun.claimed.name}: its people are claimed to have the hash {claim[:30]}, but "
            f"those of the scenario have {found[:30]}"
        )


def _not_comparable(reruns: Sequence[Rerun]) -> dict[str, str]:
    """Return metrics that were scored differently here -> explanation."""
    found: dict[str, str] = {}
    for rerun in reruns:
        for metric in sorted({s.metric for s in rerun.claimed.scores}):
            if metric in found or _same_metric(rerun, metric):
                continue
            claim, here = (r.metrics.get(metric) for r in (rerun.claimed.record, rerun.record))
            found[metric] = f"{metric} is not comparable: {_versions(claim, here)}"
    return found


def _versions(claim: MetricPart | None, here: MetricPart | None) -> str:
    """Describe how two entries of a metric differ."""
    a, b = (None if x is None else x.spec_version for x in (claim, here))
    if b is None:
        return f"version {a} was scored; here there is no such metric among those of the suite"
    if a != b:
        return f"version {a} was scored; here it has version {b}"
    return f"version {a} was scored with other parameters than those of the suite here"


def _other_conditions(rerun: Rerun) -> Iterator[str]:
    """Yield metric parameters and conditions that differ although the software is the same.

    With other versions of software or metric they may differ; such scores are neither compared nor
    ranked.
    """
    claimed, here = rerun.claimed.record, rerun.record
    if claimed.versions != here.versions:
        return
    for key in ("metrics", "conditions"):
        claims, found = (getattr(r, key) for r in (claimed, here))
        differing = [
            name
            for name in sorted(claims.keys() | found.keys())
            if claims.get(name) != found.get(name)
            and not _other_version(claims.get(name), found.get(name))
        ]
        if differing:
            yield f"{rerun.claimed.name}: {key} differ from those of the suite: " \
                  f"{', '.join(differing[:3])}"  # fmt: skip


def _other_role(rerun: Rerun) -> Iterator[str]:
    """Yield a claimed role that differs from the planner's; its behaviour cannot show it.

    For the same software, also fields that the suite defines, such as labels and metrics.
    """
    if rerun.claimed.record.versions == rerun.record.versions:
        for key in _OF_SUITE:
            claim = getattr(rerun.claimed.record, key)  # nothing of a run made from Python
            if claim and claim != getattr(rerun.record, key):
                yield f"{rerun.claimed.name}: {key} is not that of the suite"
    role, found = (r.role for r in (rerun.claimed.record, rerun.record))
    if role != found:
        yield f"{rerun.claimed.name}: role is claimed to be {role!r}, but is {found!r}"


def _other_version(a: Any, b: Any) -> bool:
    """Return True if the metric has two versions, or exists on one side only."""
    if isinstance(a, MetricPart) != isinstance(b, MetricPart):
        return True  # reported as not comparable, or left out
    both = isinstance(a, MetricPart) and isinstance(b, MetricPart)
    return both and a.spec_version != b.spec_version


# ------------------------------------------------------------------- equal trajectories
def _unequal(rerun: Rerun) -> Iterator[str]:
    """Yield scores that do not follow from the equal trajectory."""
    computed = {(s.metric, s.variant): s for s in rerun.scores}
    for score in rerun.claimed.scores:
        if not _comparable(rerun, score):
            continue
        here = computed.get((score.metric, score.variant))
        if here is None:
            yield f"{rerun.claimed.name}: {name_of(score)} is claimed, but there is no such score"
        elif not agree(score, here):
            yield (
                f"{rerun.claimed.name}: {name_of(score)} is claimed to be {shown(score)}, "
                f"but the same trajectory gives {shown(here)}"
            )
    claimed = {(s.metric, s.variant) for s in rerun.claimed.scores}
    for name in sorted(set(computed) - claimed):
        if _same_metric(rerun, name[0]) or name[0] not in rerun.claimed.record.metrics:
            yield f"{rerun.claimed.name}: {'.'.join(name)} was left out"


def _comparable(rerun: Rerun, score: Score) -> bool:
    """Return True if equal trajectories must give this score."""
    if score.metric in WALL_CLOCK or not _same_metric(rerun, score.metric):
        return False
    return rerun.own is None or (score.metric, score.variant) in rerun.own


def _same_metric(rerun: Rerun, metric: str) -> bool:
    """Return True if both used the same version and parameters of a metric."""
    sides = [r.metrics.get(metric) for r in (rerun.claimed.record, rerun.record)]
    return sides[0] == sides[1]


# --------------------------------------------------------------- different trajectories
def _beyond(others: Sequence[Rerun]) -> Iterator[str]:
    """Yield differences that another processor cannot explain."""
    for metric, spread in SPREADS.items():
        gaps = {a.claimed.name: g for a in others if (g := _gap(a, metric)) is not None}
        for name, gap in gaps.items():
            if abs(gap) > single_limit(spread):
                yield (
                    f"{name}: {metric} is off by {gap:+.3g}; processors explain "
                    f"{single_limit(spread):.3g}"
                )
        if len(gaps) > 1:
            mean, limit = sum(gaps.values()) / len(gaps), mean_limit(spread, len(gaps))
            if abs(mean) > limit:
                yield (
                    f"{metric} is off by {mean:+.3g} on the mean of {len(gaps)} runs; processors "
                    f"explain {limit:.3g}"
                )


def _gap(rerun: Rerun, metric: str) -> float | None:
    """Return claimed minus computed score; None without a value."""
    if not _same_metric(rerun, metric):
        return None
    found = []
    for scores in (rerun.claimed.scores, rerun.scores):
        values = [s.value for s in scores if (s.metric, s.variant) == (metric, variant_of(metric))]
        found.append(values[0] if values else None)
    a, b = found
    return None if a is None or b is None else a - b
