"""Read and write ``NAME.agents.csv``: all agents' tables of a suite in one CSV file.

The first column, ``draw``, names the table. Text only: no table is turned into numbers here.
"""

from __future__ import annotations

import csv
import hashlib
import io
from collections.abc import Iterable, Mapping

from crowdbot.errors import InputError

#: The last column that every table of agents has.
LAST_COLUMN = "goal_key"


def split_tables(text: str, name: str) -> dict[str, str]:
    """Return name -> table as text, taken from the file of all tables; "" -> an empty table.

    Raises:
        InputError: the text is not such a file.
    """
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise InputError(f"{name} is not a table of agents: {error}") from None
    if not rows or rows[0][:1] != ["draw"] or not all(rows):
        raise InputError(f"{name} is not a table of agents: its first column must be 'draw'")
    grouped: dict[str, list[list[str]]] = {"": [rows[0][1:]]}
    for row in rows[1:]:
        grouped.setdefault(row[0], [rows[0][1:]]).append(row[1:])
    return {key: _to_csv(_used_columns(table)) for key, table in grouped.items()}


def is_plain(text: str) -> bool:
    """Return True if a quick look proves that `split_tables` can read a text.

    False proves nothing: then call `split_tables`.
    """
    if '"' in text or "\r" in text or "\0" in text or not text.startswith("draw,"):
        return False
    lines = text.removesuffix("\n").split("\n")
    return all(lines) and max(map(len, lines)) < csv.field_size_limit()


def join_tables(tables: Mapping[str, str]) -> str:
    """Return the file of all tables; tables without agents have no rows in it.

    Columns that only some tables have stand after `LAST_COLUMN`, and are empty for the others.
    """
    read = {name: list(csv.reader(io.StringIO(t, newline=""))) for name, t in tables.items()}
    header = list(dict.fromkeys(column for rows in read.values() for column in rows[0]))
    if LAST_COLUMN in header:  # optional columns: always in the same order
        end = header.index(LAST_COLUMN) + 1
        header = header[:end] + sorted(header[end:])
    lines = [["draw", *header]]
    for name, (own, *rows) in read.items():
        place = {column: i for i, column in enumerate(own)}
        lines += [[name, *(row[place[c]] if c in place else "" for c in header)] for row in rows]
    return _to_csv(lines)


def table_hash(table: str) -> str:
    """Return the realisation hash of a table as text."""
    return f"cb1-sha256:{hashlib.sha256(table.encode()).hexdigest()}"


def _used_columns(table: list[list[str]]) -> list[list[str]]:
    """Return a table without those columns after `LAST_COLUMN` that are empty in all rows."""
    header, *rows = table
    if LAST_COLUMN not in header:
        return table
    end, width = header.index(LAST_COLUMN), len(header)
    if any(len(row) != width for row in rows):
        return table  # the reader of the table says what is wrong
    kept = [i for i in range(width) if i <= end or any(row[i] for row in rows)]
    return [[row[i] for i in kept] for row in table]


def _to_csv(rows: Iterable[list[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
