"""Detect exchanged columns of ids and frames, since people then move less from row to row."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.core.types.arrays import Array

#: Columns are exchanged if people then move this much less from row to row.
_MUCH_LESS = 0.5


def steps(columns: Mapping[str, Array]) -> tuple[float | None, float] | None:
    """Return people's moves from row to row, as read and exchanged, if the latter are far less.

    Args:
        columns: id, frame, x, y, each (K,).

    Returns:
        Medians, m; the first is None if no one is there twice. None: nothing is exchanged.
    """
    read, other = _median(columns, "id", "frame"), _median(columns, "frame", "id")
    if other is None or (read is not None and other >= _MUCH_LESS * read):
        return None
    return read, other


def _median(columns: Mapping[str, Array], person: str, frame: str) -> float | None:
    """Return the median distance between successive rows of a person, m; None without any."""
    order = np.lexsort((columns[frame], columns[person]))
    same = np.diff(columns[person][order]) == 0
    x, y = (np.diff(columns[n][order])[same] for n in ("x", "y"))
    return float(np.nanmedian(np.hypot(x, y))) if np.isfinite(x + y).any() else None
