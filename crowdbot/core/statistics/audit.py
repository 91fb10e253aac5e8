"""Audit of a suite: check that its runs separate floor planners from baseline planners."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.statistics.floors import Lead, lead_over, primary_name
from crowdbot.core.statistics.table import Table
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.text_files import input_text
from crowdbot.errors import InputError

#: Format version of the file.
FORMAT = 1
AUDIT = "audit.json"
_LEVEL = 0.95
_SHOWN = 3


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class AuditedPair(_Model):
    """A planner that should beat another.

    Attributes:
        better, worse: labels, and their roles.
        required: True if the suite fails otherwise: planners with sensors against blind floors.
            Baselines against floors with sensors, and the ceiling against baselines, are only
            reported.
        by, low, high: mean lead and its interval, in the score's unit.
    """

    better: str
    worse: str
    required: bool
    pairs: Annotated[int, Field(ge=0)]
    draws: Annotated[int, Field(ge=0)]
    by: float | None
    low: float | None
    high: float | None
    verdict: str
    reason: str

    @property
    def text(self) -> str:
        """Return the pair as a readable line."""
        why = f" ({self.reason})" if self.reason else ""
        value = "no value" if self.by is None else f"{self.by:+.3g}"
        ends = (
            "" if self.low is None or self.high is None else f" [{self.low:.3g}, {self.high:.3g}]"
        )
        return f"{self.better} over {self.worse}: {value}{ends}{why}"


class Audit(_Model):
    """The result of an audit: verdict and reason.

    Attributes:
        suite: the suite's id.
        tells_apart: True if every planner with sensors is significantly ahead of every blind floor.
        reason: why not, if the pairs do not show it.
        metric, variant: the score that decides.
        roles: planner -> floor, baseline or ceiling.
        seeds: seeds of the runs.
        scenarios: scenarios that were run -> hash of their specification.
        versions: versions of the software.
    """

    format: int = FORMAT
    suite: str
    tells_apart: bool
    reason: str
    metric: str
    variant: str
    level: float
    roles: dict[str, str]
    pairs: tuple[AuditedPair, ...]
    seeds: list[int]
    scenarios: dict[str, str]
    versions: dict[str, str]

    @property
    def failing(self) -> tuple[AuditedPair, ...]:
        """Return required pairs that were not separated, or in the wrong order."""
        return tuple(p for p in self.pairs if p.required and p.verdict != "ahead")

    @property
    def text(self) -> str:
        """Return the result as one sentence."""
        if self.tells_apart:
            return f"{self.suite} tells floors from baselines in {_plain(self.metric)}"
        pairs = [pair.text for pair in self.failing]
        more = f"; {len(pairs) - _SHOWN} more" if len(pairs) > _SHOWN else ""
        why = self.reason or "; ".join(pairs[:_SHOWN]) + more
        return f"{self.suite} cannot tell floors from baselines: {why}"

    def fits(self, runs: Sequence[RunRow]) -> bool:
        """Return True if the runs are of the suite as audited."""
        audited = [r for r in runs if r.scenario in self.scenarios]
        return bool(audited) and all(r.spec_hash == self.scenarios[r.scenario] for r in audited)


def audit(results: Results, seeing: Collection[str] = ()) -> Audit:
    """Judge a suite by the runs of floors, baselines and ceilings; other runs are ignored.

    Args:
        results: of one suite.
        seeing: labels of the floors that read sensors. Like baselines, they must beat the blind
            floors; a baseline that does not beat them proves nothing about the suite.

    Raises:
        InputError: there is no such run.
    """
    runs = [r for r in results.runs if r.role in ("floor", "baseline", "ceiling")]
    if not runs:
        raise InputError("there is no run of a floor, a baseline or a ceiling")
    roles = {r.planner: r.role for r in runs}
    table = Table(results)
    name = primary_name(table)
    pairs = [] if name is None else [
        _pair(lead_over(table, name, a, b, level=_LEVEL), required)
        for a, b, required in _wanted(roles, seeing)
    ]  # fmt: skip
    reason = _reason(roles, name is not None, pairs)
    required = [p for p in pairs if p.required]
    return Audit(
        suite=runs[0].suite,
        tells_apart=not reason and all(p.verdict == "ahead" for p in required),
        reason=reason,
        metric=name[0] if name else "",
        variant=name[1] if name else "",
        level=_LEVEL,
        roles=dict(sorted(roles.items())),
        pairs=tuple(pairs),
        seeds=sorted({r.seed for r in runs}),
        scenarios={r.scenario: r.spec_hash for r in runs},
        versions=dict(runs[0].record.versions),
    )


def _wanted(roles: Mapping[str, str], seeing: Collection[str]) -> list[tuple[str, str, bool]]:
    of = {role: sorted(p for p, r in roles.items() if r == role) for role in set(roles.values())}
    baselines, floors = of.get("baseline", []), of.get("floor", [])
    careful = [f for f in floors if f in seeing]
    blind = [f for f in floors if f not in seeing]
    required = [(a, b, True) for a in (*baselines, *careful) for b in blind]
    compared = [(b, f, False) for b in baselines for f in careful]
    return required + compared + [(c, b, False) for c in of.get("ceiling", []) for b in baselines]


def _pair(lead: Lead, required: bool) -> AuditedPair:
    return AuditedPair(
        better=lead.planner, worse=lead.other, required=required, pairs=lead.pairs,
        draws=lead.draws, by=lead.by.value, low=lead.by.low, high=lead.by.high,
        verdict=lead.verdict, reason=lead.reason,
    )  # fmt: skip


def _reason(roles: Mapping[str, str], scored: bool, pairs: Sequence[AuditedPair]) -> str:
    for role in ("floor", "baseline"):
        if role not in roles.values():
            return f"no {role} was run"
    if not scored:
        return "its runs have no score that could decide"
    if not any(p.pairs for p in pairs if p.required):
        return "no scenario was run with both a floor and a baseline"
    return ""


def suspicion(found: Audit | None, runs: Sequence[RunRow]) -> str:
    """Return a warning about the suite for readers of runs; empty if nothing is known.

    Args:
        found: the available audit.
        runs: runs of the suite.
    """
    if found is None:
        return ""
    if not found.fits(runs):
        return f"{found.suite} has changed since it was audited: audit it again"
    return "" if found.tells_apart else found.text


def write_audit(path: Path, found: Audit) -> None:
    """Write an audit file; equal input gives equal bytes.

    Raises:
        InputError: it cannot be written there.
    """
    atomic_write(path, found.model_dump_json(indent=1) + "\n")


def read_audit(path: Path) -> Audit:
    """Read an audit from its file.

    Raises:
        InputError: it cannot be read, or holds something else.
    """
    text = input_text(path)
    try:
        return Audit.model_validate_json(text)
    except ValidationError as error:
        first: Any = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        where = f"{place}: " if place else ""
        raise InputError(f"{path}: not an audit of this release: {where}{first['msg']}") from None


def _plain(metric: str) -> str:
    return metric.replace("_", " ")
