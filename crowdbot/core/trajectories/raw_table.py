"""Raw tables of recordings: cells of text, numbers or stamps, with any column names."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.arguments import expect, number_of
from crowdbot.core.support.text_files import LARGEST_TABLE, input_text
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, did_you_mean, kind_of, nearest

#: Our name of a column -> its name in the file.
ColumnNames = Mapping[str, str]
#: The cells of a column.
Cells = Sequence[Any] | NDArray[Any]
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_BEYOND = re.compile(r"[.,]\d{6}(\d{1,3})")
_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class RawTable:
    """Columns of cells, under our names.

    Attributes:
        name: name for messages.
        columns: name -> cells.
        lines: line of each row in the file; empty without a file.
        header: names of all columns in the file, including unused ones.
    """

    name: str
    columns: Mapping[str, Cells]
    lines: Sequence[int] = ()
    header: Sequence[str] = ()

    def __contains__(self, column: str) -> bool:
        return column in self.columns

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def where(self, row: int) -> str:
        """Return the name of a row for messages."""
        return f"{self.name}:{self.lines[row]}" if len(self.lines) else f"{self.name}, row {row}"

    def require(self, role: str, *columns: str) -> None:
        """Require columns of a table.

        Args:
            role: kind of table: robot, agents, trips, contacts.
            columns: required columns.

        Raises:
            InputError: a column is missing.
        """
        missing = [c for c in columns if c not in self.columns]
        if missing:
            has = ", ".join(self.header or self.columns) or "nothing"
            told = ", ".join(f"'{c}': 'ITS NAME THERE'" for c in missing)
            what = "columns {} are" if len(missing) > 1 else "column {} is"
            raise InputError(
                f"{self.name}:1: the {what.format(', '.join(missing))} missing; "
                f"the table has {has}; columns={{'{role}': {{{told}}}}} says what they are called"
            )

    def numbers(self, column: str) -> Array:
        """Return a column of numbers (K,); missing cells are NaN.

        Raises:
            InputError: a cell is not a number (the message names the line).
        """
        cells = self.columns[column]
        return np.array([self._number(column, i, cell) for i, cell in enumerate(cells)])

    def stamps(self, column: str = "t") -> NDArray[np.int64] | None:
        """Return stamps (K,) in ns since 1970, UTC; None if the column holds numbers.

        Stamps are ISO 8601 texts or dates of Python or numpy; without a zone they are UTC.

        Raises:
            InputError: a cell is not a stamp, or is empty.
        """
        cells = self.columns[column]
        if isinstance(cells, np.ndarray) and cells.dtype.kind == "M":
            self._all_there(column, ~np.isnat(cells))
            return cells.astype("datetime64[ns]").astype(np.int64)
        if not any(_is_stamp(cell) for cell in cells[:1]):
            return None
        return np.array([self._stamp(column, i, cell) for i, cell in enumerate(cells)], np.int64)

    def times(self, column: str = "t", origin: int = 0) -> tuple[Array, bool]:
        """Return times (K,) in s, and True if they are stamps.

        Args:
            column: the column's name.
            origin: ns since 1970; subtracted before conversion to s, which would round times since
                1970 to a quarter of a microsecond.

        Raises:
            InputError: a cell is neither number nor stamp, or empty.
        """
        cells, stamps = self.columns[column], self.stamps(column)
        if stamps is not None:
            return (stamps - origin) / 1e9, True
        if isinstance(cells, np.ndarray) and cells.dtype.kind == "m":
            return cells.astype("timedelta64[ns]").astype(np.int64) / 1e9, False
        times = np.array([self._number(column, i, cell) for i, cell in enumerate(cells)], float)
        self._all_there(column, np.isfinite(times))
        return times, False

    def _all_there(self, column: str, there: NDArray[np.bool_]) -> None:
        unknown = np.flatnonzero(~there)
        if len(unknown):
            raise InputError(f"{self.where(int(unknown[0]))}: a row has no {column}")

    def _number(self, column: str, row: int, cell: Any) -> float:
        try:
            return _as_number(cell)
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.where(row)}: {column}: {error}") from error

    def _stamp(self, column: str, row: int, cell: Any) -> int:
        try:
            return _as_stamp(cell)
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.where(row)}: {column}: not a stamp: {error}") from error


class Ids:
    """Numbers for people's names; whole numbers are kept."""

    def __init__(self, table: RawTable, column: str = "id") -> None:
        """Build from a column of a table.

        Raises:
            InputError: a cell is empty.
        """
        texts = [_label(cell) for cell in table.columns[column]]
        for row, text in enumerate(texts):
            if not text:
                raise InputError(f"{table.where(row)}: a row has no {column}")
        names = list(dict.fromkeys(texts))
        whole = all(re.fullmatch(r"-?\d{1,18}", name) for name in names)
        self.number = {name: int(name) if whole else i for i, name in enumerate(names)}
        self.rows: NDArray[np.int64] = np.array([self.number[t] for t in texts], dtype=np.int64)

    def of(self, table: RawTable, column: str) -> NDArray[np.int64]:
        """Return the numbers (K,) of people in another table; -1 stays -1.

        Raises:
            InputError: an unknown person is named.
        """
        found = []
        for row, cell in enumerate(table.columns[column]):
            text = _label(cell)
            if text not in self.number and text != "-1":
                near = did_you_mean(nearest(text, self.number))
                raise InputError(f"{table.where(row)}: {column}: no one is called '{text}'{near}")
            found.append(self.number.get(text, -1))
        return np.array(found, dtype=np.int64)


def read_table(path: Path, names: ColumnNames, known: Iterable[str]) -> RawTable:
    """Read a text file with a header row, separated by commas, semicolons, tabs or blanks.

    Args:
        path: the file; UTF-8.
        names: our name -> the file's name, if different.
        known: our names; other columns are ignored.

    Raises:
        InputError: it cannot be read, is not a table, or lacks a named column.
    """
    text = input_text(path, LARGEST_TABLE)
    lines = text.splitlines()
    if not lines:
        raise InputError(f"{path}:1: the file is empty")
    rows, numbers = _rows(path, text, _separator(lines[0]))
    header = [cell.strip() for cell in rows[0]]
    columns = {
        ours: [row[i] for row in rows[1:]]
        for ours, i in _chosen(str(path), header, names, known).items()
    }
    return RawTable(str(path), columns, numbers[1:], header)


def frame_table(name: str, frame: Any, names: ColumnNames, known: Iterable[str]) -> RawTable:
    """Read a pandas data frame, or any mapping of columns.

    Args:
        name: name for messages.
        frame: object with columns by name.
        names: our name -> the frame's name, if different.
        known: our names; other columns are ignored.

    Raises:
        InputError: it is not a frame, or lacks a named column.
    """
    try:
        header = [str(c) for c in frame]
        chosen = _chosen(name, header, names, known)
        keys = list(frame)
        columns = {ours: np.asarray(_plain(frame[keys[i]])) for ours, i in chosen.items()}
    except (TypeError, KeyError) as error:
        raise InputError(f"{name}: a data frame is wanted, not {kind_of(frame)}") from error
    if len({len(c) for c in columns.values()}) > 1:
        raise InputError(f"{name}: its columns differ in length")
    return RawTable(name, columns, header=header)


def in_seconds(tables: Mapping[str, RawTable], frame_rate: float | None) -> Mapping[str, RawTable]:
    """Convert times in tables from frame numbers to s.

    Args:
        tables: tables by kind.
        frame_rate: frames per second; None: times are in seconds, or stamps.

    Raises:
        InputError: the rate is not positive, or there are stamps.
    """
    if frame_rate is None:
        return tables
    if number_of("frame_rate", frame_rate, "1/s") <= 0.0:
        raise InputError(f"frame_rate is a number of frames per second, not {frame_rate!r}")
    return {name: _without_frames(table, frame_rate) for name, table in tables.items()}


def _without_frames(table: RawTable, frame_rate: float) -> RawTable:
    seconds = {}
    for name in {"t", "t0", "t1"} & set(table.columns):
        frames, stamped = table.times(name)
        if stamped:
            raise InputError(f"{table.where(0)}: {name} holds stamps; frame_rate is for frames")
        seconds[name] = frames / frame_rate
    return replace(table, columns={**table.columns, **seconds})


def _plain(series: Any) -> Any:
    """Convert stamps with a zone to UTC."""
    if getattr(getattr(series, "dtype", None), "tz", None) is not None:
        return series.dt.tz_convert("UTC").dt.tz_localize(None).to_numpy()
    return series


def _chosen(
    name: str, header: Sequence[str], names: ColumnNames, known: Iterable[str]
) -> dict[str, int]:
    """Return our column names -> their index."""
    known = list(known)
    for ours, theirs in names.items():
        expect("a column's name", theirs, str)
        if ours not in known:
            raise InputError(
                f"columns: '{ours}' is not a column of ours{did_you_mean(nearest(ours, known))}; "
                f"there are {', '.join(known)}"
            )
        if theirs not in header:
            near = did_you_mean(nearest(theirs, header))
            raise InputError(f"{name}:1: there is no column '{theirs}'{near}")
    return {
        ours: header.index(names.get(ours, ours))
        for ours in known
        if names.get(ours, ours) in header
    }


def _separator(head: str) -> str:
    """Return the separator of a header row; a blank stands for any number of blanks."""
    counts = {mark: head.count(mark) for mark in ("\t", ";", ",")}
    best = max(counts, key=lambda mark: counts[mark])
    if counts[best]:
        return best
    return " " if " " in head.strip() else ","


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
        rows.append(row)
        lines.append(line)
    if not rows:
        raise InputError(f"{path}:1: the file is empty")
    return rows, lines


def _as_number(cell: Any) -> float:
    if cell is None:
        return math.nan
    if isinstance(cell, str):
        text = cell.strip()
        if _COMMA.fullmatch(text):
            text = text.replace(",", ".")
        return float(text) if text else math.nan
    return float(cell)


def _is_stamp(cell: Any) -> bool:
    if isinstance(cell, datetime | np.datetime64):
        return True
    return isinstance(cell, str) and bool(re.match(r"\s*\d{4}-\d\d-\d\d[T ]", cell))


def _as_stamp(cell: Any) -> int:
    """Return nanoseconds since 1970."""
    if isinstance(cell, np.datetime64):
        return int(cell.astype("datetime64[ns]").astype(np.int64))
    at = cell if isinstance(cell, datetime) else datetime.fromisoformat(str(cell).strip())
    at = at if at.tzinfo else at.replace(tzinfo=UTC)
    # Python's dates end at microseconds; pandas and texts may have more digits.
    rest = _BEYOND.search(cell) if isinstance(cell, str) else None
    more = int(rest[1].ljust(3, "0")) if rest else int(getattr(at, "nanosecond", 0))
    return 1000 * int((at - _EPOCH) // timedelta(microseconds=1)) + more


def _label(cell: Any) -> str:
    """Return the text of an id; 7.0 becomes 7."""
    if cell is None or (isinstance(cell, float) and math.isnan(cell)):
        return ""
    if isinstance(cell, float | np.floating) and float(cell).is_integer():
        return str(int(cell))
    text = str(cell).strip()
    return text[:-2] if re.fullmatch(r"-?\d+\.0", text) else text
