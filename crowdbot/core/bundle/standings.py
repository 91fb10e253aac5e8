"""Who stands where: entries of one edition and one class, ranked only as far as data goes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.rows import results_of
from crowdbot.core.realism.crowds import lines_of
from crowdbot.core.results.confounds import Finding, check_comparable, confounds
from crowdbot.core.statistics import PlannerScore, Summary, summarise
from crowdbot.core.statistics.audit import Audit, suspicion
from crowdbot.core.statistics.crowds import AXIS, CrowdRanks, crowd_ranks
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Standings:
    """One table of the leaderboard.

    Attributes:
        edition, classed: of all entries.
        entries: the best in ``by`` first, those that are not ranked last.
        findings: what besides the planner differs.
        summary: of the ranked entries.
        by: metric that decides the order.
        audit: of the suite; None where nobody has audited it.
        suspicion: why ranks here may mean nothing, from the audit.
        crowds: how human the people are, a line for each different crowd.
        by_crowd: what the order owes to the crowd; None for runs in one crowd.
    """

    edition: str
    classed: str
    entries: tuple[LeaderboardEntry, ...]
    findings: tuple[Finding, ...]
    summary: Summary
    by: str
    audit: Audit | None = None
    suspicion: str = ""
    crowds: tuple[str, ...] = ()
    by_crowd: CrowdRanks | None = None

    def rank(self, metric: str, entry: LeaderboardEntry) -> int | None:
        """1 + how many are better for certain; None where it is not ranked."""
        if not entry.ranked or metric in entry.outdated:
            return None
        return self.summary.ranks(metric).get(entry.name)

    def shares_rank(self, metric: str, entry: LeaderboardEntry) -> bool:
        """Whether another entry has the same rank."""
        ranks = self.summary.ranks(metric)
        return list(ranks.values()).count(ranks.get(entry.name, 0)) > 1

    def score(self, metric: str, entry: LeaderboardEntry) -> PlannerScore | None:
        """The entry's score, if it is ranked."""
        found = (s for s in self.summary.scores if (s.metric, s.planner) == (metric, entry.name))
        return next(found, None)


def standings(
    entries: Sequence[LeaderboardEntry],
    by: str,
    accept: Iterable[str],
    audits: Iterable[Audit] = (),
) -> list[Standings]:
    """One table for each edition and class.

    Args:
        entries: from `load_entries`.
        by: metric that decides the order.
        accept: confounds that are accepted; tables print them.
        audits: of suites, those of others are left out.

    Raises:
        InputError: entries differ in more than the planner, or a suite has two audits.
        UnknownNameError: there is no such confound.
    """
    groups: dict[tuple[str, str], list[LeaderboardEntry]] = {}
    for entry in entries:
        groups.setdefault((entry.manifest.edition.name, entry.manifest.classed), []).append(entry)
    accepted, audited = tuple(accept), _by_suite(audits)
    return [
        _table(groups[key], by, accepted, audited.get(groups[key][0].manifest.edition.suite))
        for key in sorted(groups, reverse=True)
    ]


def _by_suite(audits: Iterable[Audit]) -> dict[str, Audit]:
    found: dict[str, Audit] = {}
    for audit in audits:
        if audit.suite in found:
            raise InputError(f"there are two audits of {audit.suite}; give the one that holds")
        found[audit.suite] = audit
    return found


def _table(
    entries: list[LeaderboardEntry], by: str, accept: tuple[str, ...], audit: Audit | None
) -> Standings:
    results = results_of((e.name, run) for e in entries if e.ranked for run in e.runs)
    findings = confounds(results, accept)
    check_comparable(findings)
    summary = summarise(results)
    told = [(r.axes.get(AXIS, ""), str(r.record.get("crowd") or "")) for r in results.runs]
    crowds = [(name, like) for name, like in told if name or like]
    ranks = summary.ranks(by)
    scores = [s for s in summary.scores if s.metric == by and s.mean.value is not None]
    sign = {s.planner: -1.0 if s.better == "higher" else 1.0 for s in scores}
    means = {s.planner: sign[s.planner] * (s.mean.value or 0.0) for s in scores}

    def order(entry: LeaderboardEntry) -> tuple[bool, int, int, float, str]:
        name = entry.name
        mean = means.get(name, math.inf)  # of few and short runs, where many have failed
        return not entry.ranked, ranks.get(name, 1), entry.failed, mean, name

    return Standings(
        edition=entries[0].manifest.edition.name,
        classed=entries[0].manifest.classed,
        entries=tuple(sorted(entries, key=order)),
        findings=findings,
        summary=summary,
        by=by,
        audit=audit,
        suspicion=suspicion(audit, results.runs),
        crowds=tuple(lines_of(crowds)),
        by_crowd=crowd_ranks(results, by),
    )
