"""From positions in a table or a video to metres: a matrix, its file, or metres per pixel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.trajectories.raw_table import RawTable
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Matrix (3, 3) from positions in a file to metres, a file that holds it, or metres per pixel.
Homography = ArrayLike | Path | str
#: Columns that do not hold in metres; they are derived again.
_DERIVED = ("theta", "v", "w", "vx", "vy")
#: Residual, relative to its size, above which a row counts as linearly independent of others.
_OWN = 1e-9
_WANTED = (
    "an invertible matrix of 3 x 3 numbers, from positions in the file to metres, or metres per "
    "pixel"
)


@dataclass(frozen=True, slots=True)
class VideoScale:
    """Conversion of positions and frame numbers to metres and seconds; None: as the tables state.

    Attributes:
        homography: the rows of a matrix (3, 3) from positions to metres.
        frame_rate: frames per second, > 0.
    """

    homography: tuple[tuple[float, ...], ...] | None = None
    frame_rate: float | None = None

    def __bool__(self) -> bool:
        return self.homography is not None or self.frame_rate is not None


#: Positions and times as the tables state them.
AS_STATED = VideoScale()


def video_scale(homography: str | None, frame_rate: float | None) -> VideoScale:
    """Return the scale that texts name.

    Args:
        homography: metres per pixel as a number, or a file with a matrix.
        frame_rate: frames per second.

    Raises:
        InputError: there is no such file, it holds no such matrix, or a number is not above 0.
    """
    if frame_rate is not None and not 0.0 < frame_rate < math.inf:
        raise InputError(f"a frame rate is a number of frames per second, not {frame_rate:g}")
    if homography is None:
        return VideoScale(None, frame_rate)
    try:
        given: Homography = float(homography)
    except ValueError:
        given = Path(homography)
    matrix = matrix_of(given)
    return VideoScale(tuple(tuple(row) for row in matrix.tolist()), frame_rate)


def matrix_of(homography: Homography) -> Array:
    """Return the matrix (3, 3) that is given as numbers, as one number, or as a file.

    Raises:
        InputError: it is none of these, or the file cannot be read; the message has its line.
    """
    if isinstance(homography, Path | str):
        return _matrix_in(Path(homography))
    try:
        matrix = np.asarray(homography, dtype=float)
    except (TypeError, ValueError):
        matrix = np.zeros(0)
    if matrix.ndim == 0 and 0.0 < matrix < math.inf:
        return np.diag([float(matrix), float(matrix), 1.0])
    fits = matrix.shape == (3, 3) and bool(np.all(np.isfinite(matrix)))
    if not fits or _dependent(matrix) is not None:
        raise InputError(f"homography: not {_WANTED}")
    return matrix


def _matrix_in(path: Path) -> Array:
    """Return the matrix in a file: three lines of three numbers, blanks or commas between."""
    lines = input_text(path, LARGEST_TABLE).splitlines()
    rows = [
        (number, line.replace(",", " ").split())
        for number, line in enumerate(lines, 1)
        if line.strip() and line.lstrip()[0] not in "#%"
    ]
    if not rows:
        raise InputError(f"{path}: no line has numbers; a homography is {_WANTED}")
    values = [_row(path, number, words) for number, words in rows[:3]]
    if len(rows) != 3:
        number = rows[min(len(rows) - 1, 3)][0]
        raise InputError(f"{path}:{number}: {len(rows)} rows; a homography is {_WANTED}")
    at = _dependent(np.array(values))
    if at is not None:
        raise InputError(
            f"{path}:{rows[at][0]}: the matrix is singular: this row follows from the others, so "
            f"that places cannot be told apart; a homography is {_WANTED}"
        )
    return np.array(values)


def _row(path: Path, number: int, words: Sequence[str]) -> list[float]:
    if len(words) != 3:
        some = "1 number" if len(words) == 1 else f"{len(words)} numbers"
        raise InputError(f"{path}:{number}: {some}, not 3; a homography is {_WANTED}")
    found = []
    for word in words:
        try:
            found.append(float(word))
        except ValueError:
            found.append(math.nan)
        if not math.isfinite(found[-1]):
            raise InputError(
                f"{path}:{number}: '{word[:40]}' is not a finite number; a homography is {_WANTED}"
            )
    return found


def _dependent(matrix: Array) -> int | None:
    """Return the first row that depends linearly on others, up to rounding; None if none does."""
    scaled = matrix / np.maximum(np.abs(matrix).max(axis=0), np.finfo(float).tiny)
    above = list[Array]()
    for k, row in enumerate(scaled):
        rest, size = row.copy(), float(np.linalg.norm(row))
        for _ in range(2):  # once more, against rounding
            for one in above:
                rest = rest - (rest @ one) * one
        length = float(np.linalg.norm(rest))
        if length <= _OWN * size:
            return k
        above.append(rest / length)
    return None


def projected(path: Path | str, matrix: ArrayLike, places: Array) -> Array:
    """Return places (K, 2) in metres.

    Raises:
        InputError: the matrix takes a place to infinity.
    """
    seen = np.column_stack([places, np.ones(len(places))]) @ np.asarray(matrix, float).T
    if np.any(np.abs(seen[:, 2]) < 1e-9):
        raise InputError(f"{path}: the homography takes a position to infinity: the inverse one?")
    made: Array = seen[:, :2] / seen[:, 2:]
    return made


def in_metres(table: RawTable, homography: Homography | None) -> RawTable:
    """Return a table with x and y in metres, without velocities and headings.

    Raises:
        InputError: see `matrix_of` and `projected`.
    """
    if homography is None or not {"x", "y"} <= set(table.columns):
        return table
    places = np.column_stack([table.numbers("x"), table.numbers("y")])
    x, y = projected(table.name, matrix_of(homography), places).T
    kept = {n: cells for n, cells in table.columns.items() if n not in _DERIVED}
    return replace(table, columns={**kept, "x": x, "y": y})
