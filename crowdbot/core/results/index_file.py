"""The file ``results.sqlite``: its tables, and how it is opened; an outdated one is rebuilt."""

from __future__ import annotations

import os
import sqlite3
import zlib
from pathlib import Path

from crowdbot.core.results.indexed_rows import IN_MORE, columns_of_table
from crowdbot.core.results.rows import RUN_COLUMNS
from crowdbot.errors import InputError

INDEX = "results.sqlite"
#: Longest path that SQLite opens on Unix.
_LONGEST = 504

_RUNS = ", ".join(f"{name} {kind}" for name, kind in (*RUN_COLUMNS.items(), *columns_of_table()))
_TABLES = f"""
CREATE TABLE IF NOT EXISTS runs ({_RUNS}, PRIMARY KEY (directory));
CREATE TABLE IF NOT EXISTS texts (id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE);
CREATE TABLE IF NOT EXISTS damaged (
    directory TEXT PRIMARY KEY, stamp TEXT NOT NULL, reason TEXT NOT NULL
);
CREATE TABLE IF NOT EXISTS failures (
    directory TEXT PRIMARY KEY, stamp TEXT NOT NULL, suite TEXT NOT NULL, scenario TEXT NOT NULL,
    position INTEGER NOT NULL, planner TEXT NOT NULL, seed INTEGER NOT NULL,
    axes TEXT NOT NULL, error TEXT NOT NULL, traceback TEXT NOT NULL
);
"""
#: Counts up when columns mean something else than before; other changes of columns need nothing.
_MEANING = 8
#: Identifies the tables and their columns; an index with another number is rebuilt.
VERSION = zlib.crc32(f"{_MEANING} {_TABLES} {IN_MORE}".encode()) & 0x7FFFFFFF


def reader(file: Path) -> sqlite3.Connection:
    """Open the index without creating files beside it.

    SQLite creates files beside an index with a write-ahead log (WAL), even for readers. During a
    campaign they exist; otherwise the file is complete, and is read as bytes marked as having no
    log.
    """
    if file.with_name(f"{file.name}-wal").exists():
        return sqlite3.connect(f"{file.resolve().as_uri()}?mode=ro", uri=True)
    content = bytearray(file.read_bytes())
    content[18:20] = b"\1\1"
    database = sqlite3.connect(":memory:")
    database.deserialize(bytes(content))
    return database


def opened(file: Path, *, guarded: bool = True) -> sqlite3.Connection:
    """Return a usable index; a damaged or outdated one is recreated.

    Args:
        file: the index.
        guarded: False where the file system has no locks, which SQLite would need, too.
    """
    for _ in range(2):
        try:
            if guarded:
                database = sqlite3.connect(file, timeout=30.0)
            else:
                database = sqlite3.connect(f"{file.resolve().as_uri()}?nolock=1", uri=True)
        except sqlite3.OperationalError as error:
            raise unwritable(file, error) from error
        try:
            database.execute(f"PRAGMA journal_mode = {'WAL' if guarded else 'DELETE'}")
            database.execute("PRAGMA synchronous = NORMAL")
            if database.execute("PRAGMA user_version").fetchone()[0] not in (0, VERSION):
                raise sqlite3.DatabaseError("another version")
            prepare(database)
            return database
        except sqlite3.DatabaseError as error:
            database.close()
            if isinstance(error, sqlite3.OperationalError):
                raise unwritable(file, error) from error
            for name in (file.name, f"{file.name}-wal", f"{file.name}-shm"):
                file.with_name(name).unlink(missing_ok=True)
    raise InputError(f"{file}: cannot be made")


def unwritable(file: Path, error: sqlite3.OperationalError) -> InputError:
    """Return the error of a file of SQLite that cannot be written, such as on a full disk."""
    full = getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_FULL
    length = len(os.fsencode(file.absolute()))
    if length > _LONGEST:
        return InputError(
            f"{file}: its path has {length} characters, and SQLite takes {_LONGEST}: choose a "
            "shorter folder"
        )
    return InputError(
        f"{file}: no space left on device; free some, and the same command goes on where it was"
        if full
        else f"{file}: cannot be written: {error}"
    )


def prepare(database: sqlite3.Connection) -> None:
    """Create missing tables, and write their version."""
    database.execute("PRAGMA foreign_keys = ON")
    database.executescript(_TABLES)
    database.execute(f"PRAGMA user_version = {VERSION}")
    database.commit()
