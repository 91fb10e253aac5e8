"""The verdict on a bundle from runs that were made again: comparison only, no simulation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from crowdbot.core.bundle.check import ClaimedRun
from crowdbot.core.bundle.tolerances import SPREADS, WALL_CLOCK, are_equal, mean_limit, single_limit
from crowdbot.core.types.score import Score

Outcome = Literal[
    "verified",
    "within tolerance",
    "not comparable",
    "suspicious",
    "cannot be re-run",
    "invalid",
    "not re-run",
]
#: What a bundle may be accepted with.
FINE: tuple[Outcome, ...] = ("verified", "within tolerance", "not re-run")

#: How a run that was made again relates to what the bundle claims.
#:
#: ``identical``: the trajectory is the same, bit by bit.
#: ``different``: it is not the same, although processor and software are.
#: ``different_platform``: it is not the same, but the processor or the software is not either.
#: ``nondeterministic``: not even two runs on this machine are the same.
Relation = Literal["identical", "different", "different_platform", "nondeterministic"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rerun:
    """One run, made again.

    Attributes:
        record: the new ``run.json``.
        repeated: trajectory's hash of a third time, where there was one.
        own: scores without part of calibration runs, where those may be others; None: not asked.
    """

    claimed: ClaimedRun
    record: Mapping[str, Any] = field(repr=False)
    scores: tuple[Score, ...] = field(repr=False)
    repeated: str | None = None
    own: frozenset[tuple[str, str]] | None = None

    @property
    def trajectory(self) -> str:
        """Hash of the new trajectory."""
        return _trajectory(self.record)

    @property
    def relation(self) -> Relation:
        """How both relate."""
        if self.trajectory == self.claimed.entry.trajectory:
            return "identical"
        if not self.same_platform:
            return "different_platform"
        nondeterministic = self.repeated is not None and self.repeated != self.trajectory
        return "nondeterministic" if nondeterministic else "different"

    @property
    def same_platform(self) -> bool:
        """Whether processor and software are the same, so that trajectories must be, too."""
        return same_platform(self.claimed.record, self.record)


@dataclass(frozen=True, slots=True, kw_only=True)
class RerunVerdict:
    """The outcome, and why: one line for each thing that was found.

    Attributes:
        not_comparable: metrics whose version or parameters are not those that are here.
    """

    outcome: Outcome
    findings: tuple[str, ...] = ()
    relations: Mapping[str, Relation] = field(default_factory=dict)
    not_comparable: tuple[str, ...] = ()


def verdict_of(reruns: Sequence[Rerun]) -> RerunVerdict:
    """What the runs that were made again say about a bundle."""
    relations = {a.claimed.name: a.relation for a in reruns}
    findings = [
        f"{a.claimed.name}: the trajectory is another one on the same processor "
        f"({_machine(a.record, 'processor')}) with the same software"
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
    if findings:
        outcome = "suspicious"
    return RerunVerdict(
        outcome=outcome,
        findings=(*findings, *apart.values()),
        relations=relations,
        not_comparable=tuple(apart),
    )


def same_platform(claimed: Mapping[str, Any], record: Mapping[str, Any]) -> bool:
    """Whether two records come from the same processor and software."""
    names = ("processor", "rounding")
    same = all(_machine(claimed, n) == _machine(record, n) != "" for n in names)
    return same and claimed.get("versions") == record.get("versions")


# ----------------------------------------------------------------------------- records
#: Keys of run.json that follow from the trajectory and the planner.
_ENDING = (
    "status", "goal_time", "toppled_time", "sim_time", "density", "privileged", "clamped_commands",
)  # fmt: skip
#: Those that follow from the suite.
_OF_SUITE = ("axis_words", "suite_metrics", "crowd")


def _other_ending(rerun: Rerun) -> Iterator[str]:
    """What the record claims of a run, and the same trajectory does not bear out."""
    for key in _ENDING:
        said, found = rerun.claimed.record.get(key), rerun.record.get(key)
        numbers = [x for x in (said, found) if isinstance(x, float)]
        equal = are_equal(*numbers) if len(numbers) == 2 else said == found
        if not equal:
            yield f"{rerun.claimed.name}: {key} is claimed to be {said!r}, but is {found!r}"


def _other_people(rerun: Rerun) -> Iterator[str]:
    """People who are not those of the scenario, in a suite that has no lock to compare with.

    On another platform they may be drawn differently; then the trajectory is another one, too.
    """
    said, found = (_realisation(r) for r in (rerun.claimed.record, rerun.record))
    if said != found and (rerun.same_platform or rerun.relation == "identical"):
        yield (
            f"{rerun.claimed.name}: its people are claimed to have the hash {said[:30]}, but those "
            f"of the scenario have {found[:30]}"
        )


def _realisation(record: Mapping[str, Any]) -> str:
    return str(_mapping(record, "hashes").get("realisation", ""))


def _not_comparable(reruns: Sequence[Rerun]) -> dict[str, str]:
    """Metrics that were scored otherwise than here -> what to say of each."""
    found: dict[str, str] = {}
    for rerun in reruns:
        for metric in sorted({s.metric for s in rerun.claimed.scores}):
            if metric in found or _same_metric(rerun, metric):
                continue
            said, here = (_mapping(r, "metrics").get(metric) for r in (
                rerun.claimed.record, rerun.record))  # fmt: skip
            found[metric] = f"{metric} is not comparable: {_versions(said, here)}"
    return found


def _versions(said: object, here: object) -> str:
    """How two entries of a metric differ, in words."""
    a, b = (x.get("spec_version") if isinstance(x, Mapping) else None for x in (said, here))
    if b is None:
        return f"version {a} was scored; here there is no such metric among those of the suite"
    if a != b:
        return f"version {a} was scored; here it has version {b}"
    return f"version {a} was scored with other parameters than those of the suite here"


def _other_conditions(rerun: Rerun) -> Iterator[str]:
    """Parameters of metrics and conditions that are not those of the same software here.

    With other versions of software or of a metric they may differ; such scores are not compared,
    and have no rank.
    """
    claimed, here = rerun.claimed.record, rerun.record
    if claimed.get("versions") != here.get("versions"):
        return
    for key in ("metrics", "conditions"):
        said, found = (_mapping(r, key) for r in (claimed, here))
        differing = [
            name
            for name in sorted(said.keys() | found.keys())
            if said.get(name) != found.get(name)
            and not _other_version(said.get(name), found.get(name))
        ]
        if differing:
            yield f"{rerun.claimed.name}: {key} differ from those of the suite: " \
                  f"{', '.join(differing[:3])}"  # fmt: skip


def _other_role(rerun: Rerun) -> Iterator[str]:
    """A role that the planner does not declare; nobody can see it in what it did.

    Also what the same software says of the same suite: words, named metrics, the crowd.
    """
    if rerun.claimed.record.get("versions") == rerun.record.get("versions"):
        for key in _OF_SUITE:
            said = rerun.claimed.record.get(key)  # nothing of a run that was made from Python
            if said and said != rerun.record.get(key):
                yield f"{rerun.claimed.name}: {key} is not that of the suite"
    role, found = (r.get("role", "candidate") for r in (rerun.claimed.record, rerun.record))
    if role != found:
        yield f"{rerun.claimed.name}: role is claimed to be {role!r}, but is {found!r}"


def _other_version(a: Any, b: Any) -> bool:
    """Whether these are two versions of a metric, or one that is there on one side only."""
    if isinstance(a, Mapping) != isinstance(b, Mapping):
        return True  # told as a score that is not comparable, or that was left out
    versions = [x.get("spec_version") if isinstance(x, Mapping) else None for x in (a, b)]
    return None not in versions and versions[0] != versions[1]


def _mapping(record: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = record.get(name)
    return value if isinstance(value, Mapping) else {}


# ------------------------------------------------------------------- equal trajectories
def _unequal(rerun: Rerun) -> Iterator[str]:
    """Scores that the trajectory, which is the same, does not give."""
    computed = {(s.metric, s.variant): s for s in rerun.scores}
    for score in rerun.claimed.scores:
        if not _comparable(rerun, score):
            continue
        here = computed.get((score.metric, score.variant))
        if here is None:
            yield f"{rerun.claimed.name}: {_name(score)} is claimed, but there is no such score"
        elif not _agree(score, here):
            yield (
                f"{rerun.claimed.name}: {_name(score)} is claimed to be {_said(score)}, "
                f"but the same trajectory gives {_said(here)}"
            )
    claimed = {(s.metric, s.variant) for s in rerun.claimed.scores}
    for name in sorted(set(computed) - claimed):
        if _same_metric(rerun, name[0]) or name[0] not in _mapping(rerun.claimed.record, "metrics"):
            yield f"{rerun.claimed.name}: {'.'.join(name)} was left out"


def _comparable(rerun: Rerun, score: Score) -> bool:
    """Whether a score must be the same if the trajectory is."""
    if score.metric in WALL_CLOCK or not _same_metric(rerun, score.metric):
        return False
    return rerun.own is None or (score.metric, score.variant) in rerun.own


def _agree(a: Score, b: Score) -> bool:
    for name in ("status", "symbol", "category", "unit", "better", "reason"):
        if getattr(a, name) != getattr(b, name):
            return False
    ends = ((a.value, b.value), (a.lower, b.lower), (a.upper, b.upper))
    return all(
        x is y is None or (x is not None and y is not None and are_equal(x, y)) for x, y in ends
    )


def _same_metric(rerun: Rerun, metric: str) -> bool:
    """Whether both were scored by the same version of a metric with the same parameters."""
    sides = [(r.get("metrics") or {}).get(metric) for r in (rerun.claimed.record, rerun.record)]
    return bool(sides[0] == sides[1])


# --------------------------------------------------------------- different trajectories
def _beyond(others: Sequence[Rerun]) -> Iterator[str]:
    """Differences that other processors do not explain."""
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
    """Claimed minus computed value of the corrected variant; None where one has no value."""
    if not _same_metric(rerun, metric):
        return None
    found = []
    for scores in (rerun.claimed.scores, rerun.scores):
        values = [s.value for s in scores if (s.metric, s.variant) == (metric, "corrected")]
        found.append(values[0] if values else None)
    a, b = found
    return None if a is None or b is None else a - b


# ------------------------------------------------------------------------------ texts
def _trajectory(record: Mapping[str, Any]) -> str:
    return str(record.get("hashes", {}).get("trajectory", ""))


def _machine(record: Mapping[str, Any], name: str) -> str:
    machine = record.get("machine")
    return str(machine.get(name, "")) if isinstance(machine, Mapping) else ""


def _name(score: Score) -> str:
    return f"{score.metric}.{score.variant}"


def _said(score: Score) -> str:
    return f"{score.value!r}" if score.value is not None else f"{score.status} ({score.reason})"
