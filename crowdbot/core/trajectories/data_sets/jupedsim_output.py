"""People in the databases that JuPedSim writes since 1.0: ``trajectory_data`` and ``metadata``.

Format: https://www.jupedsim.org/stable/api/jupedsim/sqlite_serialization.html, versions 1 and 2.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np

from crowdbot.core.trajectories.raw_table import RawTable
from crowdbot.errors import InputError

#: Endings of such files, and the first bytes of every database of SQLite.
ENDINGS = (".sqlite", ".sqlite3")
MAGIC = b"SQLite format 3\0"
#: Largest number of rows.
_MOST_ROWS = 10_000_000
_COLUMNS = ("frame", "id", "pos_x", "pos_y")


def is_database(path: Path) -> bool:
    """Return True for a database of SQLite, by its first bytes."""
    try:
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


def jupedsim_table(path: Path, frame_rate: float | None) -> RawTable:
    """Read the people of a database of JuPedSim: t (s, from the first frame), id, x, y (m).

    Args:
        path: the file, which is only read.
        frame_rate: frames per second; None: ``fps`` of its metadata.

    Raises:
        InputError: it is another database, or has too many rows.
    """
    try:
        uri = f"{path.resolve().as_uri()}?mode=ro&immutable=1"
        with closing(sqlite3.connect(uri, uri=True)) as base:
            rate = frame_rate or _frame_rate(path, base)
            (count,) = base.execute("SELECT COUNT(*) FROM trajectory_data").fetchone()
            if not 0 < count <= _MOST_ROWS:
                raise InputError(f"{path}: trajectory_data has {count} rows")
            rows = base.execute("SELECT frame, id, pos_x, pos_y FROM trajectory_data").fetchall()
    except sqlite3.Error as error:
        raise InputError(f"{path}: is not a database of JuPedSim's people: {error}") from None
    try:
        frame, ident, x, y = np.array(rows, np.float64).T
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: trajectory_data: {error}") from None
    columns = {"t": (frame - frame.min()) / rate, "id": ident.astype(int), "x": x, "y": y}
    others = ("ori_x", "ori_y", "geometry")
    return RawTable(str(path), columns, header=(*_COLUMNS, *others), unused=others)


def _frame_rate(path: Path, base: sqlite3.Connection) -> float:
    found = base.execute("SELECT value FROM metadata WHERE key = 'fps'").fetchone()
    try:
        rate = float(found[0])
    except (TypeError, ValueError):
        rate = 0.0
    if not 0.0 < rate < float("inf"):
        raise InputError(
            f"{path}: its metadata does not say how many frames there are in a second (fps); "
            "frame_rate=25 (--frame-rate 25) does"
        )
    return rate
