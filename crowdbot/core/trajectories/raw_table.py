"""Raw tables of recordings: cells of text, numbers or stamps, with any column names."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, did_you_mean, nearest

#: Our name of a column -> its name in the file.
ColumnNames = Mapping[str, str]
#: The cells of a column.
Cells = Sequence[Any] | NDArray[Any]
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_BEYOND = re.compile(r"[.,]\d{6}(\d{1,3})")
_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class RawTable:
    """Columns of cells, by our column names.

    Attributes:
        name: name for messages.
        columns: name -> cells.
        lines: line of each row in the file; empty without a file.
        header: names of all columns in the file, including unused ones.
        frame_rate: frames per second that the file states; None if it does not.
        counts_frames: True if its column of times is called one of frames.
        notes: sentences on what is not read, or not as it stands.
        unused: names of the columns that are not read.
        kinds: what each row is, such as ``robot``, where a column says so; else empty.
    """

    name: str
    columns: Mapping[str, Cells]
    lines: Sequence[int] = ()
    header: Sequence[str] = ()
    frame_rate: float | None = None
    counts_frames: bool = False
    notes: Sequence[str] = ()
    unused: Sequence[str] = ()
    kinds: Cells = ()

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
            role: kind of table that the caller can rename columns of: robot, agents, trips,
                contacts; empty if there is no such argument.
            columns: required columns.

        Raises:
            InputError: a column is missing.
        """
        missing = [c for c in columns if c not in self.columns]
        if missing:
            has = ", ".join(self.header or self.columns) or "nothing"
            if {"topic", "value"} <= {name.lower() for name in self.header}:
                raise InputError(
                    f"{self.name}:1: the table has a row for each value (topic, value), as plots "
                    "export them: write one column for each topic, and a row for each time"
                )
            renaming = ", ".join(f"'{c}': 'ITS NAME THERE'" for c in missing)
            subject = "columns {} are" if len(missing) > 1 else "column {} is"
            called = f"columns={{'{role}': {{{renaming}}}}} says what they are called"
            raise InputError(
                f"{self.name}:1: the {subject.format(', '.join(missing))} missing; "
                f"the table has {has}; {called if role else 'rename what holds them'}"
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

        Stamps are ISO 8601 texts or dates of Python or numpy; without a zone they are UTC. Numbers
        of milliseconds, microseconds or nanoseconds since 1970 are stamps, too.

        Raises:
            InputError: a cell is not a stamp, or is empty.
        """
        cells = self.columns[column]
        if isinstance(cells, np.ndarray) and cells.dtype.kind == "M":
            self._all_there(column, ~np.isnat(cells))
            return cells.astype("datetime64[ns]").astype(np.int64)
        unit = _unit_of_stamps(cells)
        if unit is not None:
            least = next(size for size, ns in _SINCE_1970 if ns == unit)
            ticks = [self._ticks(column, i, cell, least) for i, cell in enumerate(cells)]
            self._refuse_rounded(column, cells, ticks)
            return np.array(ticks) * unit
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
        self._refuse_clocks(column, cells)
        times = np.array([self._number(column, i, cell) for i, cell in enumerate(cells)], float)
        self._all_there(column, np.isfinite(times))
        return times, False

    def _refuse_rounded(self, column: str, cells: Cells, ticks: Sequence[int]) -> None:
        """Refuse stamps that a spreadsheet has rounded: ``1.62766E+18`` in each row."""
        rounded = isinstance(cells[0], str) and re.search(r"\de\+?\d", cells[0], re.IGNORECASE)
        if rounded and len(ticks) > 2 and len(set(ticks)) < len(ticks) / 2:
            raise InputError(
                f"{self.where(1)}: {column} is {str(cells[0]).strip()} in row after row: a "
                "spreadsheet has rounded the stamps; take the file from before it"
            )

    def _refuse_clocks(self, column: str, cells: Cells) -> None:
        """Refuse ``10:00:00.5`` and ``1.5.2026 10:00:00``, since ISO 8601 has other stamps."""
        for row, cell in enumerate(cells[:1]):
            if isinstance(cell, str) and re.search(r"\d:\d\d", cell):
                raise InputError(
                    f"{self.where(row)}: {column}: '{cell.strip()}' is neither seconds nor a stamp "
                    "of ISO 8601: write 2026-05-01T10:00:00.5, or the seconds since the start"
                )

    def _all_there(self, column: str, there: NDArray[np.bool_]) -> None:
        unknown = np.flatnonzero(~there)
        if len(unknown):
            raise InputError(f"{self.where(int(unknown[0]))}: a row has no {column}")

    def _number(self, column: str, row: int, cell: Any) -> float:
        try:
            number = as_number(cell)
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.where(row)}: {column}: {error}") from error
        if math.isinf(number):
            raise InputError(f"{self.where(row)}: {column} is infinite; leave unknown cells empty")
        return number

    def _ticks(self, column: str, row: int, cell: Any, least: float) -> int:
        try:
            text = str(cell).strip()
            ticks = int(text) if text.isdigit() else int(float(text.replace(",", ".")))
        except (ValueError, OverflowError) as error:
            raise InputError(f"{self.where(row)}: {column}: not a stamp: {cell!r}") from error
        if not least <= ticks < 100 * least:
            raise InputError(
                f"{self.where(row)}: {column}: {cell} is not a time since 1970, as the others are: "
                "not filled in? Leave out such rows"
            )
        return ticks

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


def as_number(cell: Any) -> float:
    """Return the number in a cell, also with a decimal comma; NaN if the cell stands for no value.

    Raises:
        ValueError, TypeError: it is something else.
    """
    if cell is None:
        return math.nan
    if isinstance(cell, str):
        text = cell.strip()
        if _COMMA.fullmatch(text):
            text = text.replace(",", ".")
        return math.nan if text.lower() in _UNKNOWN else float(text)
    return float(cell)


#: What programs write in cells without a value, in lower case.
_UNKNOWN = ("", "nan", "na", "n/a", "#n/a", "null", "none", "-")


#: Numbers of these sizes are stamps of the years 1973 to 2286: least number, ns in its unit.
_SINCE_1970 = ((1e17, 1), (1e14, 10**3), (1e11, 10**6))


def _unit_since_1970(cell: Any) -> int | None:
    """Return the unit of a time since 1970, ns; None for other cells, seconds included."""
    try:
        number = as_number(cell)
    except (TypeError, ValueError):
        return None
    return next((unit for least, unit in _SINCE_1970 if least <= number < 100 * least), None)


def _unit_of_stamps(cells: Cells) -> int | None:
    """Return the unit of a column of times since 1970, ns, by three of its cells; None without."""
    few = [cells[k] for k in (0, len(cells) // 2, len(cells) - 1)] if len(cells) else []
    units = [_unit_since_1970(cell) for cell in few]
    return next((unit for unit in units if unit is not None and units.count(unit) > 1), None)


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
