"""The atlas of scores, which shows what drives each metric, as a page of Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from crowdbot.core.statistics.atlas import AtlasEntry

_INTRODUCTION = """# Atlas of scores

- *moved by*: how much of the spread between the runs of one planner goes with an axis of the
  suite (omega squared, mean over planners).
- *duration*: rank correlation with how long runs last. Near 1 or -1 the score tells the time.
- *planner beats floor*: least and greatest probability, over all pairs, that a planner does better
  than a floor. At 0.5 nothing is told apart; below it floors win.
- *repeats*: scores whose ranks agree (at least 0.8); a minus: in reverse.
"""
_HEAD = ("score", "better", "runs", "moved by", "duration", "planner beats floor", "repeats")
#: Axes with a smaller effect on a score are left out.
_LITTLE = 0.05


def atlas_page(entries: Mapping[str, Sequence[AtlasEntry]]) -> str:
    """Return the atlas as Markdown: a table for each suite."""
    parts = [_INTRODUCTION]
    for suite, some in entries.items():
        parts += [f"## {suite}\n"] if len(entries) > 1 else []
        parts.append(_table(some))
    return "\n".join(parts)


def _table(entries: Sequence[AtlasEntry]) -> str:
    """Return one table; the four main scores come first."""
    rows = [_HEAD, ("---",) * len(_HEAD), *map(_row, entries)]
    return "\n".join([*(f"| {' | '.join(row)} |" for row in rows), ""])


def _row(entry: AtlasEntry) -> tuple[str, ...]:
    moves = [f"{axis} {share:.0%}" for axis, share in entry.moves if share >= _LITTLE]
    low_high = "–" if entry.separation is None else "{:.2f} to {:.2f}".format(*entry.separation)
    repeats = [f"{_name(*name)} {rho:.2f}" for name, rho in entry.repeats]
    return (
        _name(entry.metric, entry.variant),
        entry.better,
        str(entry.runs),
        ", ".join(moves) or "–",
        "–" if entry.duration is None else f"{entry.duration:.2f}",
        low_high,
        ", ".join(repeats) or "–",
    )


def _name(metric: str, variant: str) -> str:
    return f"{metric} {variant}".removesuffix(" corrected")
