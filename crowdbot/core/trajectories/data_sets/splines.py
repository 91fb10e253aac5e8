"""People in UCY's ``.vsp`` files: splines whose control points have a frame number.

Each file begins with the number of splines; each spline with its number of control points, which
are lines of x, y, frame and direction of gaze. What follows `` - `` on a line is a comment.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.trajectories.data_sets.homography import Homography, matrix_of, projected
from crowdbot.core.trajectories.plausibility.times import PERSON_SPEED
from crowdbot.core.trajectories.raw_table import RawTable
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: Frames per second of the videos, and annotations per second of the tables made of them.
_VIDEO, _ANNOTATIONS = 25.0, 2.5
_COMMENT = re.compile(r"(?:^|\s)-(?:\s.*|\(.*)?$")
#: File that has the matrix, in copies of the data set.
_BESIDE = "H.txt"
_DIGITS = 15
#: Largest number of rows of a table: two hours of a hundred people.
_MOST_ROWS = 2_000_000


def is_spline_file(path: Path, text: str) -> bool:
    """Return True for a file of UCY's splines, by its name or its first line."""
    return path.suffix.lower() == ".vsp" or "number of splines" in text[:200].split("\n", 1)[0]


def spline_table(
    path: Path, homography: Homography | None, frame_rate: float | None
) -> tuple[RawTable, list[str]]:
    """Read people, 2.5 times a second, on straight lines between their control points.

    Args:
        path: the file.
        homography: see `Homography`; None: ``H.txt`` beside the file, else the positions are
            metres if no one then walks faster than people can.
        frame_rate: frames per second of the video; None: 25.

    Returns:
        Table of t, id, x, y, in s and m; and sentences on what was assumed or left out.

    Raises:
        InputError: it cannot be read, or positions are pixels and nothing says how large.
    """
    rate = _VIDEO if frame_rate is None else frame_rate
    step = max(1, round(rate / _ANNOTATIONS))
    splines = list(_splines(path, input_text(path, LARGEST_TABLE).splitlines()))
    matrix, notes = _matrix(path, homography, splines, rate)
    _check_length(path, splines, step)
    rows = []
    absent = 0
    for person, points in enumerate(splines):
        frames, first = np.unique(points[:, 2], return_index=True)
        grid = np.arange(np.ceil(frames[0] / step) * step, frames[-1] + 0.5, step)
        place = projected(path, matrix, points[first, :2])
        absent += len(grid) == 0
        x, y = (np.interp(grid, frames, place[:, k]) for k in (0, 1))
        rows += [(f / rate, person, *xy) for f, *xy in zip(grid, x, y, strict=True)]
    if not rows:
        raise InputError(f"{path}: no one is there at a multiple of {step} frames")
    if absent:
        notes.append(f"{absent} of {len(splines)} people are there for less than {step} frames")
    found = np.array(rows)
    t = found[:, 0] - found[:, 0].min()
    columns = {"t": t, "id": found[:, 1].astype(int), "x": found[:, 2], "y": found[:, 3]}
    return RawTable(str(path), columns), notes


def _splines(path: Path, lines: Sequence[str]) -> Iterator[Array]:
    """Yield the control points of each spline, (K, 4): x, y, frame, gaze in degrees."""
    rows = [(n, words) for n, line in enumerate(lines, 1) if (words := _words(line))]
    count, at = _count(path, rows, 0, "splines"), 1
    for spline in range(count):
        size, at = _count(path, rows, at, f"control points of spline {spline + 1}"), at + 1
        points = rows[at : at + size]
        if len(points) < size:
            raise InputError(
                f"{path}: ends in spline {spline + 1} of {count}, at control point "
                f"{len(points)} of {size}"
            )
        if size:
            yield np.array([_point(path, number, words) for number, words in points])
        at += size


def _check_length(path: Path, splines: Sequence[Array], step: int) -> None:
    """Refuse third numbers other than frames of a video, such as stamps in nanoseconds.

    Raises:
        InputError: the table would have too many rows.
    """
    lengths = [float(np.ptp(points[:, 2])) / step for points in splines]
    if sum(lengths) > _MOST_ROWS:
        worst = int(np.argmax(lengths))
        first, last = np.min(splines[worst][:, 2]), np.max(splines[worst][:, 2])
        raise InputError(
            f"{path}: spline {worst + 1} lasts from frame {first:.10g} to {last:.10g}; the third "
            "number of a control point is its frame"
        )


def _words(line: str) -> list[str]:
    return _COMMENT.sub("", line.strip()).split()


def _count(path: Path, rows: Sequence[tuple[int, list[str]]], at: int, counted: str) -> int:
    if at >= len(rows):
        raise InputError(f"{path}: ends where the number of {counted} should be")
    number, words = rows[at]
    if len(words) != 1 or not words[0].isdigit() or len(words[0]) > _DIGITS:
        raise InputError(
            f"{path}:{number}: '{' '.join(words)}' is not the number of {counted}; files of UCY "
            "have one above the control points (x y frame gaze)"
        )
    return int(words[0])


def _point(path: Path, number: int, words: Sequence[str]) -> list[float]:
    try:
        point = [float(word) for word in words[:4]]
    except ValueError as error:
        raise InputError(f"{path}:{number}: {error}; x y frame gaze are wanted") from error
    if len(point) < 3 or not np.all(np.isfinite(point)):
        raise InputError(f"{path}:{number}: x y frame gaze are wanted, not {' '.join(words)}")
    return [*point, 0.0][:4]


def _matrix(
    path: Path, homography: Homography | None, splines: Sequence[Array], rate: float
) -> tuple[Array, list[str]]:
    """Return the matrix (3, 3) from positions to metres, and what was assumed."""
    beside = path.parent / _BESIDE
    if homography is not None:
        return matrix_of(homography), []
    speed = _speed(splines, rate)
    if beside.is_file():
        return matrix_of(beside), [f"positions become metres by {_BESIDE} beside it"]
    if speed <= PERSON_SPEED:
        return np.eye(3), [
            f"positions are taken for metres: people walk at {speed:.2g} m/s (median)"
        ]
    raise InputError(
        f"{path}: positions are pixels (people move by {speed:.3g} a second, median), and nothing "
        f"says how large one is: put {_BESIDE} of the data set, a matrix of 3 x 3 from pixels to "
        "metres, beside it, or give such a matrix, its file, or metres per pixel: --homography on "
        "the command line, Trajectories.from_eth_ucy(path, homography=...) in Python"
    )


def _speed(splines: Sequence[Array], rate: float) -> float:
    """Return the median speed between control points, in positions per second."""
    steps = [np.diff(points[:, :3], axis=0) for points in splines if len(points) > 1]
    moved = np.concatenate(steps) if steps else np.zeros((0, 3))
    moved = moved[moved[:, 2] > 0.0]
    if not len(moved):
        return 0.0
    return float(np.median(np.hypot(moved[:, 0], moved[:, 1]) / moved[:, 2])) * rate
