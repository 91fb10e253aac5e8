"""Floors: test if a planner beats the floor planners in the primary score.

A planner has to beat every floor. All of these tests must succeed together, so none needs a
correction for the others (Berger 1982, intersection-union test).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from crowdbot.core.results.results import Results
from crowdbot.core.scoring import four_scores
from crowdbot.core.statistics.comparison import Comparison, compare
from crowdbot.core.statistics.estimate import NOTHING, Estimate
from crowdbot.core.statistics.sign_flip import least_p
from crowdbot.core.statistics.summary import headline_names
from crowdbot.core.statistics.table import MISSING, Name, Table
from crowdbot.core.support.text import plural

#: Candidates for the deciding score, the first that the runs have: older runs lack the first.
PRIMARY = (four_scores.PRIMARY.metric, "success_no_collision", "success")

_TOO_FEW = "too few crowd draws"
LeadVerdict = Literal["ahead", "behind", "not distinguishable"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Lead:
    """The lead of one planner over another in one score.

    Attributes:
        pairs, draws: scenarios and seeds that both have run; crowd draws among them.
        by: mean lead over the pairs, in the score's unit, positive where ``planner`` is better.
        verdict: ``ahead`` or ``behind`` only if the interval excludes 0, every pair has a value,
            no run of the planner is missing and there are enough draws for a test; else ``reason``
            may say why not.
    """

    planner: str
    other: str
    pairs: int
    draws: int
    by: Estimate = NOTHING
    verdict: LeadVerdict = "not distinguishable"
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorCheck:
    """Comparison of one planner with all floors that were run.

    Attributes:
        metric, variant: the score; empty if the runs have no deciding score.
        leads: lead over each floor, smallest first.
    """

    planner: str
    metric: str
    variant: str
    leads: tuple[Lead, ...] = ()

    @property
    def beats_all(self) -> bool:
        """Return True if there are floors and the planner is ahead of each."""
        return bool(self.leads) and all(lead.verdict == "ahead" for lead in self.leads)

    @property
    def undecided(self) -> str:
        """Return the reason if it alone keeps the planner from a lead over each floor, else ""."""
        reasons = {lead.reason for lead in self.leads}
        few = len(reasons) == 1 and next(iter(reasons)).startswith(_TOO_FEW)
        return reasons.pop() if few else ""

    @property
    def text(self) -> str:
        """Return the sentence that the report shows first."""
        if not self.leads:
            return (
                f"{self.planner}: no floor planner ran in these scenarios, "
                "so the scores have no yardstick"
            )
        score, lost = self.metric.replace("_", " "), [x for x in self.leads if x.verdict != "ahead"]
        if not lost:
            names = ", ".join(x.other for x in self.leads)
            return f"{self.planner} beats the floors in {score}: {_by(self.leads[0])} ({names})"
        if self.undecided:
            return f"{self.planner}: no verdict against the floors in {score}: {_leads_text(lost)}"
        return f"{self.planner} does not beat the floors in {score}: {_leads_text(lost)}"


def check_floors(
    results: Results, *, level: float = 0.95, table: Table | None = None
) -> tuple[FloorCheck, ...]:
    """Compare each planner with every floor, by name; floors themselves are not checked.

    Args:
        results: comparable runs.
        level: confidence level of the intervals.
        table: the table of these results, if already built.
    """
    roles = {run.planner: run.role for run in results.runs}
    table = table or Table(results)
    floors = [p for p in table.planners if roles.get(p) == "floor"]
    name = primary_name(table)
    return tuple(
        against_floors(table, name, planner, floors, level=level)
        for planner in table.planners
        if planner not in floors
    )


def against_floors(
    table: Table, name: Name | None, planner: str, floors: Iterable[str], *, level: float = 0.95
) -> FloorCheck:
    """Compare one planner with some floors; floors without a common scenario and seed are left out.

    Args:
        table: table of the runs.
        name: from `primary_name`.
        planner, floors: labels.
        level: confidence level of the intervals.
    """
    if name is None:
        return FloorCheck(planner=planner, metric="", variant="")
    leads = [lead_over(table, name, planner, floor, level=level) for floor in floors]
    met = sorted((x for x in leads if x.pairs), key=lambda x: (_low(x), x.other))
    return FloorCheck(planner=planner, metric=name[0], variant=name[1], leads=tuple(met))


def primary_name(table: Table) -> Name | None:
    """Return the deciding score: the first headline among `PRIMARY`."""
    headlines = dict(headline_names(table))
    found = (metric for metric in PRIMARY if metric in headlines)
    metric = next(found, None)
    return None if metric is None else (metric, headlines[metric])


def lead_over(table: Table, name: Name, planner: str, other: str, *, level: float = 0.95) -> Lead:
    """Return the lead of a planner over another in one score."""
    found, _ = compare(table, name, planner, other, level=level)
    sign = 1.0 if found.better in ("higher", "none") else -1.0
    by = _turned(found.difference, sign)
    gone = table.lacking(planner) & (table.column(name, other).outcome != MISSING)
    lacking = _lacking(table, name, planner, other)
    verdict, reason = _verdict(found, by, lacking, int(gone.sum()), level)
    return Lead(
        planner=planner, other=other, pairs=found.pairs, draws=found.draws, by=by,
        verdict=verdict, reason=reason,
    )  # fmt: skip


def _turned(estimate: Estimate, sign: float) -> Estimate:
    if sign > 0 or estimate.value is None:
        return estimate
    low = None if estimate.high is None else -estimate.high
    high = None if estimate.low is None else -estimate.low
    return Estimate(value=-estimate.value, low=low, high=high, reason=estimate.reason)


def _lacking(table: Table, name: Name, *planners: str) -> int:
    """Count pairs that both have run, in which one has no value."""
    columns = [table.column(name, planner) for planner in planners]
    tried = np.all([c.outcome != MISSING for c in columns], axis=0)
    return int(np.count_nonzero(tried & ~np.all([c.known for c in columns], axis=0)))


def _verdict(
    comparison: Comparison, by: Estimate, lacking: int, gone: int, level: float
) -> tuple[LeadVerdict, str]:
    if comparison.better == "none":
        return "not distinguishable", "nothing says which values are better"
    if by.low is None or by.high is None:
        return "not distinguishable", by.reason or comparison.reason
    if lacking:  # leaving out runs that went badly must not be an advantage
        return "not distinguishable", f"{lacking} of {comparison.pairs} pairs have no value"
    if gone and by.low > 0.0:
        return "not distinguishable", f"{plural(gone, 'run')} of the planner missing"
    # An interval needs two draws; with so few, any difference may be chance.
    if least_p(comparison.draws) > 1.0 - level:
        return "not distinguishable", f"{_TOO_FEW}: {comparison.draws}"
    if by.low > 0.0:
        return "ahead", ""
    return ("behind", "") if by.high < 0.0 else ("not distinguishable", "")


def _low(lead: Lead) -> float:
    return float("-inf") if lead.by.low is None else lead.by.low


def _leads_text(leads: Sequence[Lead]) -> str:
    """Return all leads as text; a shared reason is given once."""
    reasons = {lead.reason for lead in leads}
    if len(leads) == 1 or len(reasons) > 1 or reasons == {""}:
        return "; ".join(map(_by, leads))
    every = "both" if len(leads) == 2 else "all"
    leaders = "; ".join(_by(replace(lead, reason="")) for lead in leads)
    return f"{leaders} ({every}: {leads[0].reason})"


def _by(lead: Lead) -> str:
    """Return a lead such as ``+0.31 [0.22, 0.40] against stop_and_go, 18 pairs, 6 crowd draws``."""
    why = f" ({lead.reason})" if lead.reason else ""
    counts = f"{plural(lead.pairs, 'pair')}, {plural(lead.draws, 'crowd draw')}"
    place = f"{lead.other}, {counts}"
    if lead.by.value is None:
        return f"not comparable with {place}{why}"
    ends = (lead.by.low, lead.by.high)
    interval = "" if None in ends else f" [{ends[0]:.3g}, {ends[1]:.3g}]"
    return f"{lead.by.value:+.3g}{interval} against {place}{why}"
