"""Scores as rows of a table, with a column per run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from crowdbot.core.scoring.four_scores import main_first, name_of
from crowdbot.core.scoring.scores_csv import headlines, section_of
from crowdbot.core.types.score import Score

_ARROWS = {
    "higher": ("↑", "higher is better"),
    "lower": ("↓", "lower is better"),
    "reference": ("◎", "the reference is best"),
    "none": ("", ""),
}


class Cell(NamedTuple):
    """The score of one run."""

    value: str
    status: str
    reason: str


class ScoreLine(NamedTuple):
    """One line of the table; ``headline``: shown by default."""

    metric: str
    variant: str
    unit: str
    arrow: str
    meaning: str
    headline: bool
    cells: list[Cell]

    @property
    def status(self) -> str:
        """Return the common status of all cells; ``ok`` if they differ."""
        found = {cell.status for cell in self.cells}
        return found.pop() if len(found) == 1 else "ok"


def compared(runs: Sequence[Sequence[Score]]) -> dict[str, list[ScoreLine]]:
    """Return category -> rows, in the given order; the four main scores come first.

    Args:
        runs: the scores of each run; missing ones are empty cells.
    """
    groups: dict[str, list[ScoreLine]] = {}
    by_name = [{(s.metric, s.variant): s for s in scores} for scores in runs]
    first = {name: score for scores in reversed(by_name) for name, score in scores.items()}
    given = [first[name] for name in dict.fromkeys(name for scores in by_name for name in scores)]
    chosen = {(s.metric, s.variant) for scores in runs for s in headlines(scores)}
    for score in main_first(given, lambda s: (s.metric, s.variant)):
        name = (score.metric, score.variant)
        cells = [_cell(scores.get(name)) for scores in by_name]
        groups.setdefault(_words(section_of(score)), []).append(
            _row(score, cells, headline=name in chosen)
        )
    return groups


def _row(score: Score, cells: list[Cell], *, headline: bool) -> ScoreLine:
    arrow, meaning = _ARROWS[score.better]
    return ScoreLine(
        metric=_name(score),
        variant=_words(score.variant),
        unit="" if score.unit == "1" else score.unit,
        arrow=arrow,
        meaning=meaning,
        headline=headline,
        cells=cells,
    )


def _name(score: Score) -> str:
    """Return the metric in words; for the four main scores, their role comes first."""
    name, metric = name_of(score.metric, score.variant), _words(score.metric)
    return metric if name in (score.metric, metric) else f"{name} ({metric})"


def _cell(score: Score | None) -> Cell:
    if score is None:
        return Cell("–", "absent", "")
    return Cell(_value(score), score.status, _words(score.reason))


def _value(score: Score) -> str:
    if score.value is not None:
        return _digits(score.value)
    bounds = []
    if score.lower is not None:
        bounds.append(f"≥ {_digits(score.lower)}")
    if score.upper is not None:
        bounds.append(f"≤ {_digits(score.upper)}")
    return " ".join(bounds) or "–"


def _digits(value: float) -> str:
    """Return four significant digits; integers unchanged."""
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return f"{value:.4g}".replace("e-0", "e-").replace("e+0", "e")


def _words(name: str) -> str:
    return name.replace("_", " ")
