"""The head of a report: a verdict in one sentence, and the main scores of each planner."""

from __future__ import annotations

from typing import NamedTuple

from crowdbot.core.scoring.four_scores import MAIN_SCORES
from crowdbot.core.statistics.sample_size import SampleSize
from crowdbot.core.statistics.summary import PlannerScore, Summary
from crowdbot.core.support.text import listed

_ARROWS = {"higher": "higher is better", "lower": "lower is better"}


class LeadColumn(NamedTuple):
    """One main score: its role, its unit and direction, and a score for each planner."""

    role: str
    about: str
    scores: tuple[PlannerScore, ...]


def main_columns(summary: Summary) -> tuple[LeadColumn, ...]:
    """Return the four scores that runs have; the first headline score if they have none."""
    by_name: dict[tuple[str, str], list[PlannerScore]] = {}
    for score in summary.scores:
        by_name.setdefault((score.metric, score.variant), []).append(score)
    main = [(s.role, by_name.get((s.metric, s.variant), [])) for s in MAIN_SCORES]
    found = [(role, scores) for role, scores in main if scores]
    if not found and by_name:
        (metric, _), scores = next(iter(by_name.items()))
        found = [(metric.replace("_", " "), scores)]
    return tuple(LeadColumn(role, _about(scores[0]), tuple(scores)) for role, scores in found)


def verdict(summary: Summary, sample: SampleSize | None, *, useless: bool = False) -> str:
    """Return in one or two sentences which planner is better, or why that is not known.

    Args:
        summary: of the headline scores.
        sample: check of the sample size.
        useless: True if the suite cannot distinguish planners.
    """
    if len(summary.planners) < 2:
        return f"Only {summary.planners[0]} has runs, so there is nothing to compare it with."
    if useless:
        return "No verdict: this suite cannot distinguish planners."
    if sample is not None and sample.too_small:
        return (
            f"No verdict: the runs have {sample.draws} different "
            f"crowd{'s' * (sample.draws != 1)}, and a verdict needs at least {sample.least}."
        )
    columns = main_columns(summary)
    if not columns:
        return "No verdict: the runs have no scores."
    return _by_ranks(summary, columns[0])


def _by_ranks(summary: Summary, column: LeadColumn) -> str:
    ranks = summary.ranks(column.scores[0].metric)
    if not ranks:
        return f"No verdict: nothing says which {column.role} is better."
    first = [p for p in summary.planners if ranks.get(p) == 1]
    others = [p for p in summary.planners if p not in first]
    if not others:
        return f"No difference in {column.role} beyond chance between {listed(first)}."
    if len(first) == 1:
        beaten = _surely_beaten(summary, column, first[0])
        if set(beaten) == set(others):
            return f"{first[0]} is better than {listed(others)} in {column.role}."
    return (
        f"{listed(first)} {'leads' if len(first) == 1 else 'lead'} in {column.role}; "
        f"{listed(others)} {'is' if len(others) == 1 else 'are'} worse than at least one planner."
    )


def _surely_beaten(summary: Summary, column: LeadColumn, planner: str) -> list[str]:
    metric, variant = column.scores[0].metric, column.scores[0].variant
    here = [c for c in summary.comparisons if (c.metric, c.variant) == (metric, variant)]
    won = [c.b for c in here if c.a == planner and c.verdict == "better"]
    return [*won, *(c.a for c in here if c.b == planner and c.verdict == "worse")]


def _about(score: PlannerScore) -> str:
    unit = "" if score.unit == "1" else score.unit
    return ", ".join(filter(None, (unit, _ARROWS.get(score.better, ""))))
