"""Tables out of pandas data frames and trajectories of PedPy."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from crowdbot.core.trajectories.message_columns import joined
from crowdbot.core.trajectories.raw_table import Cells, ColumnNames, RawTable
from crowdbot.core.trajectories.table_columns.completed import completed
from crowdbot.core.trajectories.table_columns.names import FRAMES, chosen
from crowdbot.core.trajectories.table_columns.units import scaled, unit_of, without_units
from crowdbot.errors import InputError, kind_of


def frame_table(name: str, frame: Any, names: ColumnNames, known: Iterable[str]) -> RawTable:
    """Read a pandas data frame, any mapping of columns, or trajectories of PedPy.

    Args:
        name: name for messages.
        frame: object with columns by name; or with such ``data`` and a ``frame_rate``.
        names: our name -> the frame's name, if different.
        known: our names; other columns are named in the table's notes.

    Raises:
        InputError: it is not a frame, or lacks a named column.
    """
    rate = getattr(frame, "frame_rate", None) if hasattr(frame, "data") else None
    frame = frame.data if rate is not None else frame
    try:
        spelled = [str(c) for c in frame]
        header = without_units(spelled)
        made = chosen(name, header, names, known, spelled)
        keys = dict(zip(header, frame, strict=True))

        def cells(column: str) -> Cells:
            return np.asarray(_plain(frame[keys[column]]))

        columns = {
            ours: scaled(name, ours, cells(header[i]), unit_of(ours, spelled[i], 1.0), ())
            for ours, i in made.items()
        }
    except (TypeError, KeyError) as error:
        raise InputError(f"{name}: a data frame is wanted, not {kind_of(frame)}") from error
    if len({len(c) for c in columns.values()}) > 1:
        raise InputError(f"{name}: its columns differ in length")
    counts = "t" in made and header[made["t"]].lower() in FRAMES
    raw = RawTable(name, columns, header=spelled, frame_rate=rate, counts_frames=counts)
    raw, more = joined(raw, made, lambda place: cells(header[place]), known)
    return completed(raw, header, cells, 1.0, {*made.values(), *more}, wide="id" in known)


def _plain(series: Any) -> Any:
    """Convert stamps with a zone to UTC."""
    if getattr(getattr(series, "dtype", None), "tz", None) is not None:
        return series.dt.tz_convert("UTC").dt.tz_localize(None).to_numpy()
    return series
