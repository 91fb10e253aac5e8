"""Ladders of sensing: the same planner with increasingly better knowledge.

The loss by perception is the lead of the top rung over the planner with real sensors; the loss by
planning is the difference of the top rung to the best value of the score.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.record_parts import PlannerPart
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.floors import Lead, lead_over, primary_name
from crowdbot.core.statistics.summary_estimator import planner_mean
from crowdbot.core.statistics.table import MISSING, Name, Table

#: Fields of planners on the ladder, and their values from the ground up.
RUNGS: Mapping[str, tuple[str, ...]] = {
    "tracks": ("lidar", "tracker", "truth"),
    "localisation": ("odometry", "corrected", "truth"),
}
#: Size of the plot and its margins, px; the score goes from 0 to 1.
_WIDTH, _HEIGHT, _LEFT, _BELOW, _EDGE = 420.0, 220.0, 46.0, 56.0, 14.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Rung:
    """One planner with one choice of knowledge.

    Attributes:
        planner: its label in the runs.
        tracks, localisation: what it knows of people and of its own place.
        runs: number of its runs.
        score: mean with its interval.
        gain: lead over the rung below, over common runs; None on the lowest one.
    """

    planner: str
    tracks: str
    localisation: str
    runs: int
    score: Estimate
    gain: Lead | None = None

    @property
    def name(self) -> str:
        """Return people and place, ``tracker / corrected``."""
        return f"{self.tracks} / {self.localisation}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Ladder:
    """The rungs of one planner, the lowest first.

    Attributes:
        kind: of the planner.
        metric, variant: the score.
        rungs: at least two.
        climb: lead of the highest rung over the lowest one.
    """

    kind: str
    metric: str
    variant: str
    rungs: tuple[Rung, ...]
    climb: Lead

    @property
    def plot(self) -> list[dict[str, float]]:
        """Return px of each rung: x, and y of the mean and of the interval's ends."""
        step = (_WIDTH - _LEFT - _EDGE) / len(self.rungs)
        return [
            {"x": round(_LEFT + (i + 0.5) * step, 1), **_heights(rung.score)}
            for i, rung in enumerate(self.rungs)
        ]


def ladders(
    results: Results,
    name: Name | None = None,
    *,
    level: float = 0.95,
    table: Table | None = None,
) -> tuple[Ladder, ...]:
    """Return the ladder of each planner that ran on two rungs or more, sorted by kind.

    Planners whose other parameters differ have ladders of their own.

    Args:
        results: comparable runs.
        name: the score; None: the primary one.
        level: confidence level of the intervals.
        table: the table of these results, if already built.
    """
    table = table or Table(results)
    name = name or primary_name(table)
    if name is None:
        return ()
    found = (_ladder(table, name, labels, level) for labels in _on_ladders(results.runs))
    return tuple(sorted((x for x in found if x is not None), key=lambda x: x.kind))


def _on_ladders(runs: Sequence[RunRow]) -> Iterator[dict[str, PlannerPart]]:
    """Yield label -> planner for planners whose knowledge is a parameter and that else agree."""
    groups: dict[str, dict[str, PlannerPart]] = {}
    first: dict[str, RunRow] = {}
    for run in runs:
        first.setdefault(run.planner, run)
    for label, run in first.items():
        given = run.record.planner.model_dump()
        if all(given.get(field) in values for field, values in RUNGS.items()):
            rest = {k: v for k, v in sorted(given.items()) if k not in (*RUNGS, "name", "label")}
            groups.setdefault(repr(rest), {})[label] = run.record.planner
    yield from groups.values()


def _ladder(
    table: Table, name: Name, labels: Mapping[str, PlannerPart], level: float
) -> Ladder | None:
    if len(labels) < 2:
        return None
    rungs: list[Rung] = []
    for label in sorted(labels, key=lambda label: _height(labels[label])):
        given = labels[label].model_dump()
        gain = lead_over(table, name, label, rungs[-1].planner, level=level) if rungs else None
        rungs.append(
            Rung(
                planner=label,
                tracks=given["tracks"],
                localisation=given["localisation"],
                runs=int((table.column(name, label).outcome != MISSING).sum()),
                score=planner_mean(table, name, label, level),
                gain=gain,
            )
        )
    return Ladder(
        kind=next(iter(labels.values())).kind,
        metric=name[0],
        variant=name[1],
        rungs=tuple(rungs),
        climb=lead_over(table, name, rungs[-1].planner, rungs[0].planner, level=level),
    )


def _height(planner: PlannerPart) -> tuple[int, ...]:
    """Return the place of a rung: knowledge of people comes before that of the place."""
    given = planner.model_dump()
    return tuple(values.index(given[field]) for field, values in RUNGS.items())


def _heights(score: Estimate) -> dict[str, float]:
    value = score.value or 0.0
    ends = {"y": value, "y0": score.low, "y1": score.high}
    room = _HEIGHT - _BELOW - _EDGE
    return {
        end: round(_HEIGHT - _BELOW - min(1.0, max(0.0, value if v is None else v)) * room, 1)
        for end, v in ends.items()
    }
