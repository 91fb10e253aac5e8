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
    place = (columns["x"], columns["y"])
    read = median_step(columns["id"], columns["frame"], *place)
    other = median_step(columns["frame"], columns["id"], *place)
    if other is None or (read is not None and other >= _MUCH_LESS * read):
        return None
    return read, other


def median_step(person: Array, frame: Array, x: Array, y: Array) -> float | None:
    """Return the median distance between successive rows of a person, m; None without any."""
    order = np.lexsort((frame, person))
    same = np.diff(person[order]) == 0
    dx, dy = (np.diff(axis[order])[same] for axis in (x, y))
    return float(np.nanmedian(np.hypot(dx, dy))) if np.isfinite(dx + dy).any() else None
