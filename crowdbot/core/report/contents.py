"""Contents of a report: the common source of its page, CSV and Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import crowdbot.core.report.provenance as provenance
from crowdbot.core.realism.crowds import lines_of
from crowdbot.core.realism.near_robots.known import response_lines
from crowdbot.core.registry.registry import Registry
from crowdbot.core.report.cards import cards
from crowdbot.core.report.encode import Attempt, attempts, axes_of, status_of
from crowdbot.core.report.figures import Figures, figures
from crowdbot.core.report.series import Series, all_series
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow, named_metrics
from crowdbot.core.results.score_columns import metrics_of
from crowdbot.core.scoring.score_scale import score_scales
from crowdbot.core.statistics.audit import Audit, suspicion
from crowdbot.core.statistics.crowds import AXIS, CrowdRanks, crowd_ranks
from crowdbot.core.statistics.floors import FloorCheck, check_floors
from crowdbot.core.statistics.ladder import Ladder, ladders
from crowdbot.core.statistics.pareto import ParetoPoint, label_heights, pareto
from crowdbot.core.statistics.rules import Orders, orders
from crowdbot.core.statistics.sample_size import SampleSize, sample_size
from crowdbot.core.statistics.table import Table
from crowdbot.core.types.ending import shown
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class Heading:
    """The head and provenance of a report, from the caller.

    Attributes:
        suite: the suite's id.
        made: creation time of the report, as text.
        command: the command line.
        accepted: accepted differences between the runs, one sentence each.
        warnings: differences that do not prevent a comparison.
        references: planners whose scores are given for comparison.
        audit: audit of the suite, if there is one.
    """

    suite: str
    made: str = ""
    command: str = ""
    accepted: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    references: tuple[str, ...] = ()
    audit: Audit | None = None


@dataclass(frozen=True, kw_only=True)
class Contents:
    """Contents of one report.

    Attributes:
        attempts: runs, then failures without a later successful run.
        axes: ``name`` and ``labels`` of each axis.
        cards: metric -> contents of its card.
        replays: run id -> address of its replay page, relative to the report.
        floors: comparison of each planner with the floors.
        suspicion: why the results may be meaningless; empty if there is no reason.
        sample: check of the sample size for a verdict; None if nothing is compared.
        crowds: realism of the runs' people, a line per different crowd.
        responses: realism of their response to the robot, a line per kind.
        orders: orders of the planners by the ranking rule, and by others beside it; None for one
            planner.
        ranks: dependence of the order of planners on the crowd; None for runs of one crowd.
    """

    heading: Heading
    results: Results
    attempts: list[Attempt]
    axes: list[dict[str, Any]]
    series: list[Series]
    figures: Figures
    cards: dict[str, dict[str, Any]]
    replays: Mapping[str, str]
    floors: tuple[FloorCheck, ...]
    suspicion: str
    crowds: tuple[str, ...] = ()
    responses: tuple[str, ...] = ()
    sample: SampleSize | None = None
    ranks: CrowdRanks | None = None
    orders: Orders | None = None
    ladders: tuple[Ladder, ...] = ()

    @property
    def planners(self) -> tuple[str, ...]:
        """Return the labels of all planners, sorted."""
        return self.figures.planners

    @property
    def pareto(self) -> tuple[ParetoPoint, ...]:
        """Return planners by safe efficiency and acceptance; empty for fewer than two."""
        return pareto(self.figures.headline)

    @property
    def pareto_labels(self) -> dict[str, float]:
        """Return the y position of each planner's name in the plot of `pareto`, px."""
        return label_heights(self.pareto)

    @cached_property
    def seeds(self) -> list[int]:
        """Return all seeds, in order."""
        return sorted({a.seed for a in self.attempts})

    @cached_property
    def hashes(self) -> Mapping[str, str]:
        """Return hashes of the data."""
        return provenance.hashes(self.results.runs)

    @cached_property
    def facts(self) -> Mapping[str, Mapping[str, str]]:
        """Return software, machine, plugins and conditions of the runs."""
        return provenance.facts(self.results.runs)

    @cached_property
    def statuses(self) -> Mapping[str, int]:
        """Return how many attempts of all planners had each outcome."""
        return Counter(map(status_of, self.attempts))

    @cached_property
    def _by_planner(self) -> Mapping[str, list[Attempt]]:
        found: dict[str, list[Attempt]] = {}
        for attempt in self.attempts:
            found.setdefault(attempt.planner, []).append(attempt)
        return found

    def of(self, planner: str) -> list[Attempt]:
        """Return the attempts of one planner."""
        return self._by_planner.get(planner, [])

    def counts(self, attempts: Sequence[Attempt] | None = None) -> dict[str, int]:
        """Return how many attempts had each outcome; default: all attempts."""
        chosen = self.attempts if attempts is None else attempts
        found = Counter(status_of(a) for a in chosen)
        return {ending: found[ending] for ending in shown(self.statuses)}

    def is_privileged(self, planner: str) -> bool:
        """Return True if a planner got ground truth in any run."""
        return any(isinstance(a, RunRow) and a.privileged for a in self.of(planner))

    def is_person(self, planner: str) -> bool:
        """Return True if people drove in any run."""
        return any(isinstance(a, RunRow) and a.by_person for a in self.of(planner))

    def role(self, planner: str) -> str:
        """Return a planner's role."""
        roles = (a.role for a in self.of(planner) if isinstance(a, RunRow))
        return next(roles, "candidate")

    def is_pinned(self, planner: str) -> bool:
        """Return True if all runs of a planner used only code from installed distributions."""
        return all(a.pinned for a in self.of(planner) if isinstance(a, RunRow))


def crowd_lines(runs: Sequence[RunRow]) -> list[str]:
    """Return the realism of the people in some runs; runs without people are skipped."""
    labels = [(r.axes.get(AXIS, ""), r.crowd) for r in runs]
    return lines_of((name, like) for name, like in labels if name or like)


def gather(
    results: Results, registry: Registry, heading: Heading, replays: Mapping[str, str]
) -> Contents:
    """Compute the contents of a report.

    Args:
        results: comparable runs of one suite.
        registry: registry with the metrics' cards.
        heading: head of the report.
        replays: run id -> address of the replay page.

    Raises:
        InputError: there is no run.
    """
    if not results.runs:
        raise InputError("there is no run to report about")
    results = replace(results, scales=score_scales(registry))
    axes = axes_of(results)
    found = cards(registry, sorted(metrics_of(results.scores)))
    table = Table(results)
    series = all_series(table, named_metrics(results.runs))
    worked_out = figures(results, table, series, axes)
    return Contents(
        heading=heading,
        results=results,
        attempts=attempts(results),
        axes=axes,
        series=series,
        figures=worked_out,
        cards=found,
        replays=replays,
        floors=check_floors(results, table=table),
        suspicion=suspicion(heading.audit, results.runs),
        crowds=tuple(crowd_lines(results.runs)),
        responses=tuple(
            response_lines([r.conditions.get("people_and_robot", "") for r in results.runs])
        ),
        sample=sample_size(worked_out.headline),
        ranks=crowd_ranks(results, table=table),
        orders=orders(table, results.marks) if len(table.planners) > 1 else None,
        ladders=ladders(results, table=table),
    )
