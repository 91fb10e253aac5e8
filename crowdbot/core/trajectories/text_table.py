"""Read tables of text: comments, header rows or none, separators, units, wide tables."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.trajectories.message_columns import joined
from crowdbot.core.trajectories.raw_table import Cells, ColumnNames, RawTable, as_number
from crowdbot.core.trajectories.table_columns.completed import completed
from crowdbot.core.trajectories.table_columns.frames import whole_numbers
from crowdbot.core.trajectories.table_columns.names import FRAMES, chosen
from crowdbot.core.trajectories.table_columns.units import (
    length_unit,
    scaled,
    unit_of,
    without_unit,
    without_units,
)
from crowdbot.errors import InputError

#: A row of text is a comment if it begins with one of these.
COMMENTS = ("#", "%", "//")
_RATE = re.compile(
    r"frame[\s_-]*rate\s*[:=]?\s*(\d+(?:[.,]\d+)?)|\bfps\s*[:=]\s*(\d+(?:[.,]\d+)?)"
    r"|(\d+(?:[.,]\d+)?)\s*fps\b",
    re.IGNORECASE,
)
#: Columns of trajectories of PeTrack and JuPedSim, where no comment names them.
_TRAJECTORY = ("id", "frame", "x", "y", "z")
#: What JuPedSim appends: half-axes, angle and colour of the ellipse that is drawn.
_ELLIPSE = ("a", "b", "angle", "color")


@dataclass(frozen=True, slots=True)
class TextTable:
    """Rows of cells (R, C), all of one width, with their lines in the file.

    Attributes:
        header: names of the columns, from the first row or a comment; empty without either.
        assumed: True if nothing names them: they are those of PeTrack and JuPedSim.
        frame_rate: frames per second that a comment states; None if none does.
        unit: metres in the unit of lengths that a comment states; 1 if none does.
    """

    header: list[str]
    rows: list[list[str]]
    lines: list[int]
    frame_rate: float | None
    unit: float
    assumed: bool = False


def read_table(path: Path, names: ColumnNames, known: Iterable[str]) -> RawTable:
    """Read a text file, separated by commas, semicolons, tabs or blanks.

    Args:
        path: the file; UTF-8.
        names: our name -> the file's name, if different.
        known: our names; other columns are named in the table's notes.

    Raises:
        InputError: it cannot be read, is not a table, or lacks a named column.
    """
    known = list(known)
    table = split(path, input_text(path, LARGEST_TABLE))
    if not table.rows:
        raise InputError(f"{path}: the table has no rows")
    if not table.header:
        raise InputError(f"{path}:{table.lines[0]}: {_nameless(table.rows[0], known)}")
    header = without_units(table.header)
    cells = {name: [row[i] for row in table.rows] for i, name in enumerate(header)}
    made = chosen(str(path), header, names, known, spelled=table.header)
    columns: dict[str, Cells] = {
        ours: scaled(
            str(path),
            ours,
            cells[header[i]],
            unit_of(ours, table.header[i], table.unit),
            table.lines,
        )
        for ours, i in made.items()
    }
    counts = "t" in made and header[made["t"]].lower() in FRAMES
    raw = RawTable(
        str(path), columns, table.lines, table.header, table.frame_rate, counts_frames=counts
    )
    if table.assumed and {"t", "id"} <= set(made):
        whole_numbers(raw, "t", "id")
    raw, more = joined(raw, made, lambda place: [row[place] for row in table.rows], known)
    used = {*made.values(), *more}
    return completed(raw, header, cells.__getitem__, table.unit, used, wide="id" in known)


def split(path: Path, text: str) -> TextTable:
    """Split a text into a header and rows.

    Raises:
        InputError: it is empty, or rows differ in length.
    """
    lines = _plain_viswalk(text.splitlines())
    if lines and SEPARATOR_LINE.fullmatch(lines[0]):
        lines[0] = ""
    comments = [line for line in lines if line.lstrip().startswith(COMMENTS)]
    first = next((line for line in lines if line.strip() and line not in comments), "")
    if not first:
        raise InputError(f"{path}:1: the file is empty")
    if "number of splines" in first:
        raise InputError(
            f"{path}: has splines of UCY, not a table of rows; Trajectories.from_eth_ucy(path, "
            "homography=...) reads it"
        )
    for start, other in _DOCUMENTS.items():
        if first.strip().startswith(start) or first.strip() == "[":
            raise InputError(
                f"{path}: is {other}, not a table of rows; convert it to CSV with t,id,x,y"
            )
    mark = _separator(first)
    plain = "\n".join("" if line.lstrip().startswith(COMMENTS) else line for line in lines)
    rows, numbers = _rows(path, plain, mark)
    has_header = not any(_is_number(cell) for cell in rows[0])
    if has_header:
        header = [cell.strip() for cell in rows[0]]
        rows, numbers = rows[1:], numbers[1:]
        header = _in_groups(header, rows)
    else:
        header = _header_of_comments(comments, len(rows[0]), mark) or _of_tum(rows)
    assumed = not header and _of_petrack(comments, len(rows[0]))
    if assumed:
        header = list((*_TRAJECTORY, *_ELLIPSE)[: len(rows[0])])
    comment = " ".join(comments)
    rate = _frame_rate(path, comments)
    return TextTable(header, rows, numbers, rate, length_unit(comment) or 1.0, assumed)


def _nameless(row: Sequence[str], known: Sequence[str]) -> str:
    """Return what is wrong with a row whose columns nothing names."""
    if len(row) == _KITTI and _is_pose(row):
        return (
            "12 numbers a row are poses of KITTI, matrices (3, 4) without times, of a camera that "
            "looks along z: write a table t,x,y of its times, column 12 and minus column 4"
        )
    return (
        "the table has no header row that names its columns: write one above it, such as "
        f"'{','.join(known[:4])}'"
    )


def _is_pose(row: Sequence[str]) -> bool:
    """Return True for 12 numbers of a matrix (3, 4) that begins with a rotation."""
    if not all(_is_number(cell) for cell in row):
        return False
    turn = np.array([as_number(cell) for cell in row], float).reshape(3, 4)[:, :3]
    return bool(np.allclose(turn @ turn.T, np.eye(3), atol=1e-3))


def _in_groups(header: list[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return names with those of their groups: bagToCsv writes ``position,x,y,z,orientation,x,…``.

    A group's own column has no cells, and loses its name. Tables whose names differ are kept.
    """
    if len(set(header)) == len(header) or not rows:
        return header
    group, found = "", []
    for i, name in enumerate(header):
        if not any(row[i].strip() for row in rows):
            group = name
            found.append("")
        else:
            found.append(f"{group}.{name}" if group else name)
    return found


def _plain_viswalk(lines: list[str]) -> list[str]:
    """Return the lines of a file of Viswalk as those of other tables, in their places.

    Its remarks begin with ``*`` and ``$``, its header with ``$PEDESTRIAN:``, where NO is a person's
    number.
    """
    head = next((k for k, line in enumerate(lines) if line.upper().startswith(_VISWALK)), None)
    if head is None:
        return lines
    names = lines[head][len(_VISWALK) :].split(";")
    header = ";".join("id" if name.strip().upper() == "NO" else name for name in names)
    rest = ("" if line.startswith(("*", "$")) else line for line in lines[head + 1 :])
    return [""] * head + [header, *rest]


def _is_number(cell: str) -> bool:
    try:
        return bool(cell.strip()) and as_number(cell) is not None
    except ValueError:
        return False


def _of_tum(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the columns of TUM's benchmark if rows end in quaternions and begin with times."""
    if len(rows[0]) != len(_TUM):
        return []
    try:
        numbers = [[as_number(cell) for cell in row] for row in rows]
    except ValueError:
        return []
    turns = all(abs(math.hypot(*row[4:]) - 1.0) < _NEARLY_ONE for row in numbers)
    times = [row[0] for row in numbers]
    return list(_TUM) if turns and all(a < b for a, b in pairwise(times)) else []


def _header_of_comments(comments: Sequence[str], width: int, mark: str) -> list[str]:
    """Return the names of columns in the last comment that has one for each; empty if none has.

    Comments that name people or times come first: others may be sentences about x and y.
    """
    for comment in comments:
        if comment.startswith("%time,") and comment.count(",") == width - 1:  # rostopic echo -p
            return [word.strip() for word in comment.split(",")]
    named = [c for c in comments if set(re.split(r"[^a-z_]+", c.lower())) & set(_STARTS)]
    for comment in [*reversed(named), *reversed(comments)]:
        words = re.split(r"[\s,;]+", re.sub(r"\s*[\[(]", "[", comment.lstrip("#%/ \t")).strip())
        names = [without_unit(word.strip("\"':")).lower() for word in words if word]
        if any(x in names and y in names for x, y in _PLACES):
            first = (*_STARTS, *(name for pair in _PLACES for name in pair))
            starts = (names.index(name) for name in names if name in first)
            words = words if len(words) == width else words[min(starts) :]
            if len(words) >= width:
                return [word.strip("\"':") for word in words[:width]]
    for comment in reversed(named):
        words = [word.strip() for word in comment.lstrip("#%/ \t").split(mark)]
        if mark != " " and len(words) == width and all(words):
            return words
    return []


def _of_petrack(comments: Sequence[str], width: int) -> bool:
    """Return True for a table of PeTrack or JuPedSim, whose columns no comment needs to name."""
    known = any(_RATE.search(c) or "petrack" in c.lower() for c in comments)
    return known and width in (4, 5, len(_TRAJECTORY) + len(_ELLIPSE))


#: Names of the two coordinates in comments; those of TUM's benchmark come second.
_PLACES = (("x", "y"), ("tx", "ty"))
_TUM = ("timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw")
#: Numbers in each row of a file of KITTI's odometry.
_KITTI = 12
#: Quaternions have the length 1, but for rounding.
_NEARLY_ONE = 0.02
_VISWALK = "$PEDESTRIAN:"
#: How files begin that are not tables.
_DOCUMENTS = {
    "{": "JSON", "[{": "JSON", "[[": "JSON", "<": "XML or HTML",
    "header:": "what 'ros2 topic echo' prints of a bag, which from_rosbag reads",
    "NO_OF_FRAMES": "Qualisys' export of markers", "Format Version,": "Motive's export of markers",
}  # fmt: skip
#: First line that names the separator for spreadsheets.
SEPARATOR_LINE = re.compile(r'\s*"?sep=(.)"?\s*', re.IGNORECASE)
_STARTS = (
    "id", "persid", "personid", "ped_id", "pers", "person", "t", "time", "timestamp", *FRAMES,
)  # fmt: skip


def _frame_rate(path: Path, comments: Sequence[str]) -> float | None:
    """Return the number of frames per second that comments state, if any does.

    Raises:
        InputError: they state several.
    """
    found = [match for comment in comments for match in _RATE.finditer(comment)]
    texts = (next(group for group in match.groups() if group) for match in found)
    rates = sorted({float(text.replace(",", ".")) for text in texts} - {0.0})
    if len(rates) > 1:
        stated = " and ".join(f"{rate:g}" for rate in rates)
        raise InputError(
            f"{path}: its comments state {stated} frames per second; keep the true one"
        )
    return rates[0] if rates else None


def _separator(head: str) -> str:
    """Return the separator of a row; a blank stands for any number of blanks."""
    counts = {mark: head.count(mark) for mark in ("\t", ";", ",")}
    best = "\t" if counts["\t"] else ";" if counts[";"] else ","
    if counts[best] and not (best == "," and _has_decimal_commas(head)):
        return best
    return " " if " " in head.strip() else ","


def _has_decimal_commas(head: str) -> bool:
    """Return True if all commas of a row separated by blanks are those of numbers."""
    words = head.split()
    return len(words) > 2 and all(re.fullmatch(r"[+-]?\d+(,\d+)?", word) for word in words)


def _rows(path: Path, text: str, mark: str) -> tuple[list[list[str]], list[int]]:
    """Return rows of cells and their lines, without blank rows."""
    rows, lines = [], []
    try:
        if mark == " ":
            parts = [line.split() for line in text.splitlines()]
            numbered = list(enumerate(parts, 1))
        else:
            reader = csv.reader(io.StringIO(text, newline=""), delimiter=mark, strict=True)
            numbered = [(reader.line_num, row) for row in reader]
    except csv.Error as error:
        raise InputError(f"{path}: not a table: {error}") from error
    width = 0
    for line, row in numbered:
        if not any(cell.strip() for cell in row):
            continue
        width = width or len(row)
        if len(row) < width:
            raise InputError(f"{path}:{line}: the row is too short: {len(row)} cells of {width}")
        if any(cell.strip() for cell in row[width:]):
            raise InputError(
                f"{path}:{line}: {len(row)} cells, and the first row has {width}: a separator "
                "that is also a decimal comma, or a header that lacks a name?"
            )
        rows.append(row)
        lines.append(line)
    if not rows:
        raise InputError(f"{path}:1: the file is empty")
    if width > 2 and all(len(row) == width and not row[-1].strip() for row in rows):
        rows = [row[:-1] for row in rows]  # each row ends with a separator
    return rows, lines
