"""Scores as the rows of a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from crowdbot.core.scoring.four_scores import main_first
from crowdbot.core.scoring.scores_csv import headlines, section_of
from crowdbot.core.types.score import Score

_ARROWS = {
    "higher": ("↑", "higher is better"),
    "lower": ("↓", "lower is better"),
    "reference": ("◎", "the reference is best"),
    "none": ("", ""),
}


class Row(NamedTuple):
    """One line of the table; ``headline``: shown before anybody asks for all variants."""

    metric: str
    symbol: str
    variant: str
    value: str
    unit: str
    arrow: str
    meaning: str
    status: str
    reason: str
    headline: bool


def grouped(scores: Sequence[Score]) -> dict[str, list[Row]]:
    """Category -> rows, in the order given; the four scores are the first one."""
    groups: dict[str, list[Row]] = {}
    chosen = {id(s) for s in headlines(scores)}
    for score in main_first(scores, lambda s: (s.metric, s.variant)):
        row = _row(score, headline=id(score) in chosen)
        groups.setdefault(_words(section_of(score)), []).append(row)
    return groups


def _row(score: Score, *, headline: bool) -> Row:
    arrow, meaning = _ARROWS[score.better]
    return Row(
        metric=_words(score.metric),
        symbol=score.symbol,
        variant=_words(score.variant),
        value=_value(score),
        unit="" if score.unit == "1" else score.unit,
        arrow=arrow,
        meaning=meaning,
        status=score.status,
        reason=_words(score.reason),
        headline=headline,
    )


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
    """Four significant digits, integers as they are."""
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return f"{value:.4g}".replace("e-0", "e-").replace("e+0", "e")


def _words(name: str) -> str:
    return name.replace("_", " ")
