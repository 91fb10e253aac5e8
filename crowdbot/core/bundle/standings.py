"""Leaderboard standings: entries of one edition and class, ranked as far as data allows."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.rows import results_of
from crowdbot.core.realism.crowds import lines_of
from crowdbot.core.results.confounds import Finding, check_comparable, confounds
from crowdbot.core.scoring.four_scores import PRIMARY
from crowdbot.core.scoring.score_scale import Scales
from crowdbot.core.statistics.audit import Audit, suspicion
from crowdbot.core.statistics.crowds import AXIS, CrowdRanks, crowd_ranks
from crowdbot.core.statistics.ranking import SCORES
from crowdbot.core.statistics.rules import RULE, Orders, orders
from crowdbot.core.statistics.sample_size import sample_size
from crowdbot.core.statistics.summary import PlannerScore, Summary, summarise
from crowdbot.core.statistics.table import Table
from crowdbot.errors import InputError

#: Metrics that the ranking rule weighs up.
RULE_METRICS = frozenset(metric for names in SCORES.values() for metric, _ in names[:1])


@dataclass(frozen=True, slots=True, kw_only=True)
class Standings:
    """One table of the leaderboard.

    Attributes:
        edition, classed: edition and class of all entries.
        entries: best in ``by`` first, unranked ones last.
        findings: differences other than the planner.
        summary: summary of the ranked entries.
        by: the metric that decides the order, or `RULE`.
        orders: orders by the ranking rule, and by others beside it.
        audit: audit of the suite, or None.
        suspicion: why ranks may be meaningless, from the audit.
        crowds: realism of the people, a line per different crowd.
        by_crowd: dependence of the order on the crowd; None for runs in one crowd.
    """

    edition: str
    classed: str
    entries: tuple[LeaderboardEntry, ...]
    findings: tuple[Finding, ...]
    summary: Summary
    by: str
    orders: Orders
    audit: Audit | None = None
    suspicion: str = ""
    crowds: tuple[str, ...] = ()
    by_crowd: CrowdRanks | None = None

    @property
    def too_small(self) -> str:
        """Return why there are too few crowds to separate ranks; empty if there are enough."""
        size = sample_size(self.summary)
        return size.text if size and self.ranks(self.by) else ""

    def ranks(self, by: str) -> Mapping[str, int]:
        """Return entry -> rank in a metric or by `RULE`; empty if there is nothing to order by."""
        if by == RULE:
            return {} if self.orders.missing else self.orders.rule.ranks
        return self.summary.ranks(by)

    def rank(self, by: str, entry: LeaderboardEntry) -> int | None:
        """Return 1 + the number of significantly better entries; None if not ranked."""
        needed = RULE_METRICS if by == RULE else {by}
        if not entry.ranked or needed & set(entry.outdated):
            return None
        return self.ranks(by).get(entry.name)

    def shares_rank(self, by: str, entry: LeaderboardEntry) -> bool:
        """Return True if another entry has the same rank."""
        ranks = self.ranks(by)
        return list(ranks.values()).count(ranks.get(entry.name, 0)) > 1

    def score(self, metric: str, entry: LeaderboardEntry) -> PlannerScore | None:
        """Return the entry's score, if ranked."""
        found = (s for s in self.summary.scores if (s.metric, s.planner) == (metric, entry.name))
        return next(found, None)


def standings(
    entries: Sequence[LeaderboardEntry],
    by: str,
    accept: Iterable[str],
    audits: Iterable[Audit] = (),
    scales: Scales | None = None,
) -> list[Standings]:
    """Return one table per edition and class.

    Args:
        entries: from `load_entries`.
        by: metric that decides the order, or `RULE`.
        accept: accepted confounds, which the tables show.
        audits: audits of suites; unrelated ones are ignored.
        scales: scales of the scores, from `score_scales`, which bound the intervals.

    Raises:
        InputError: entries differ in more than the planner, or a suite has two audits.
        UnknownNameError: there is no such confound.
    """
    groups: dict[tuple[str, str], list[LeaderboardEntry]] = {}
    for entry in entries:
        groups.setdefault((entry.manifest.edition_name, entry.manifest.classed), []).append(entry)
    accepted, audited = tuple(accept), _by_suite(audits)
    return [
        _table(
            groups[key],
            by,
            accepted,
            audited.get(groups[key][0].manifest.edition.suite),
            scales or {},
        )
        for key in sorted(groups, reverse=True)
    ]


def set_apart(
    entries: Sequence[LeaderboardEntry], accept: Iterable[str]
) -> tuple[list[LeaderboardEntry], dict[str, str]]:
    """Split entries into comparable ones and the others, with reasons, by file name.

    Verified entries take precedence, then those comparable with most others of their edition and
    class; ties go to the first.

    Raises:
        UnknownNameError: there is no such confound.
    """
    accepted = tuple(accept)
    confounds(results_of(()), accepted)  # a wrong name is the user's fault, not a bundle's
    groups: dict[tuple[str, str], list[LeaderboardEntry]] = {}
    for entry in entries:
        groups.setdefault((entry.manifest.edition_name, entry.manifest.classed), []).append(entry)
    why: dict[str, str] = {}
    for group in groups.values():
        why |= _strangers(group, accepted)
    return [e for e in entries if e.path.name not in why], why


def _strangers(group: Sequence[LeaderboardEntry], accept: tuple[str, ...]) -> dict[str, str]:
    """Return why entries of one table cannot be compared with most of its others."""
    why = dict[str, str]()
    for entry in group:
        if text := _own_trouble(entry, accept):
            why[entry.path.name] = text
    left = [e for e in group if e.path.name not in why]
    if not _difference(left, accept):
        return why
    fits = {
        frozenset((a.path, b.path))
        for i, a in enumerate(left)
        for b in left[:i]
        if not _difference((a, b), accept)
    }

    def liked(entry: LeaderboardEntry) -> tuple[bool, int]:
        others = [o for o in left if frozenset((entry.path, o.path)) in fits]
        return entry.is_verified, sum(o.is_verified for o in others) or len(others)

    kept: list[LeaderboardEntry] = []
    for entry in sorted(left, key=liked, reverse=True):  # stable for equal keys
        if text := _difference([*kept, entry], accept):
            why[entry.path.name] = f"cannot be compared with {kept[0].path.name}: {text}"
        else:
            kept.append(entry)
    return why


def _own_trouble(entry: LeaderboardEntry, accept: tuple[str, ...]) -> str:
    """Return why an entry is inconsistent by itself; empty if it is not."""
    try:
        if text := _difference((entry,), accept):
            return f"its own runs cannot be compared: {text}"
        summarise(results_of((entry.name, run) for run in entry.runs))
    except Exception as error:  # any error concerns one bundle only
        return f"malformed: {type(error).__name__}: {str(error)[:200]}"
    return ""


def _difference(entries: Sequence[LeaderboardEntry], accept: tuple[str, ...]) -> str:
    """Return the first difference of entries other than the planner; empty if there is none."""
    results = results_of((e.name, run) for e in entries if e.ranked for run in e.runs)
    errors = [f for f in confounds(results, accept) if f.severity == "error" and not f.accepted]
    kinds = ", ".join(dict.fromkeys(f.kind for f in errors))
    return f"{str(errors[0])[:300]}; to compare all the same, --accept {kinds}" if errors else ""


def _by_suite(audits: Iterable[Audit]) -> dict[str, Audit]:
    found: dict[str, Audit] = {}
    for audit in audits:
        if audit.suite in found:
            raise InputError(f"there are two audits of {audit.suite}; give the one that holds")
        found[audit.suite] = audit
    return found


def _table(
    entries: list[LeaderboardEntry],
    by: str,
    accept: tuple[str, ...],
    audit: Audit | None,
    scales: Scales,
) -> Standings:
    rows = results_of((e.name, run) for e in entries if e.ranked for run in e.runs)
    results = replace(rows, scales=scales)
    findings = confounds(results, accept)
    check_comparable(findings)
    table = Table(results)
    summary, ordered = summarise(results, table=table), orders(table)
    labels = [(r.axes.get(AXIS, ""), r.record.crowd or "") for r in results.runs]
    crowds = [(name, like) for name, like in labels if name or like]
    metric = PRIMARY.metric if by == RULE else by  # of equal ranks, the better mean is first
    ranks = ordered.rule.ranks if by == RULE else summary.ranks(by)
    scores = [s for s in summary.scores if s.metric == metric and s.mean.value is not None]
    sign = {s.planner: -1.0 if s.better == "higher" else 1.0 for s in scores}
    means = {s.planner: sign[s.planner] * (s.mean.value or 0.0) for s in scores}

    def order(entry: LeaderboardEntry) -> tuple[bool, int, int, float, str]:
        name = entry.name
        mean = means.get(name, math.inf)  # few, short runs, many failed
        return not entry.ranked, ranks.get(name, 1), entry.failed, mean, name

    return Standings(
        edition=entries[0].manifest.edition_name,
        classed=entries[0].manifest.classed,
        entries=tuple(sorted(entries, key=order)),
        findings=findings,
        summary=summary,
        by=by,
        orders=ordered,
        audit=audit,
        suspicion=suspicion(audit, results.runs),
        crowds=tuple(lines_of(crowds)),
        by_crowd=crowd_ranks(results, metric),
    )
