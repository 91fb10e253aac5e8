"""results.sqlite: an index of the run directories below a root, which can always be rebuilt.

The directories are authoritative. One process at a time, a campaign with ``results.lock``, writes
the index; readers update a copy in memory and write nothing.
"""

from __future__ import annotations

import json
import logging
import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

from crowdbot.core.results.failure import SUFFIX, Failure, read_failure
from crowdbot.core.results.rows import RUN_COLUMNS, DamagedRun, RunRow, ScoreRow
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.scores_csv import RunScore, read_scores_csv, safe_cell
from crowdbot.core.support.locks import try_lock
from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")
INDEX, LOCK = "results.sqlite", "results.lock"
#: Version of the tables; an index of another version is rebuilt.
VERSION = 4

#: Columns of a run besides `RUN_COLUMNS`; ``axes``, ``conditions`` and ``record`` are JSON.
_BESIDE = {
    "stamp": "TEXT", "position": "INTEGER", "axes": "TEXT", "conditions": "TEXT", "record": "TEXT",
}  # fmt: skip
_RUNS = ", ".join(f"{name} {kind}" for name, kind in {**RUN_COLUMNS, **_BESIDE}.items())
_TABLES = f"""
CREATE TABLE IF NOT EXISTS runs ({_RUNS}, PRIMARY KEY (directory));
CREATE TABLE IF NOT EXISTS scores (
    directory TEXT NOT NULL REFERENCES runs ON DELETE CASCADE, row INTEGER NOT NULL,
    category TEXT NOT NULL, metric TEXT NOT NULL, symbol TEXT NOT NULL, variant TEXT NOT NULL,
    value REAL, unit TEXT NOT NULL, better TEXT NOT NULL, status TEXT NOT NULL,
    reason TEXT NOT NULL, lower REAL, upper REAL, PRIMARY KEY (directory, row)
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS failures (
    directory TEXT PRIMARY KEY, stamp TEXT NOT NULL, suite TEXT NOT NULL, scenario TEXT NOT NULL,
    position INTEGER NOT NULL, planner TEXT NOT NULL, seed INTEGER NOT NULL,
    axes TEXT NOT NULL, error TEXT NOT NULL, traceback TEXT NOT NULL
);
"""


class StoredRows(NamedTuple):
    """Everything below a root: runs in the documented order, scores by run, and failures."""

    runs: tuple[RunRow, ...]
    scores: tuple[ScoreRow, ...]
    failures: tuple[Failure, ...]
    damaged: tuple[DamagedRun, ...]


def read_rows(root: Path) -> StoredRows:
    """Return all current runs, scores and failures below a root, without writing.

    A damaged run is left out, with a warning.

    Raises:
        InputError: there is no such folder.
    """
    if not root.is_dir():
        raise InputError(f"{root}: no folder of results; 'crowdbot campaign' makes one")
    with _copy(root) as store:
        store.synchronise()
        found = store.rows()
    for run in found.damaged:
        _LOG.warning("warning: %s is left out: %s", root / run.directory, run.reason)
    return found


@contextmanager
def index(root: Path) -> Iterator[Store]:
    """Yield the index of a root for the only process that may write it.

    Raises:
        InputError: it cannot be written, or another process is writing it.
    """
    try:
        root.mkdir(parents=True, exist_ok=True)
        handle = os.open(root / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise InputError(f"{root}: cannot be written: {error.strerror}") from error
    try:
        try:
            state = try_lock(handle, root / LOCK)
        except OSError as error:
            raise InputError(f"{root}: cannot be locked: {error.strerror}") from error
        if state == "taken":
            raise InputError(f"{root}: another campaign is writing there")
        with closing(_opened(root / INDEX, guarded=state == "locked")) as database:
            yield Store(root, database)
    finally:
        os.close(handle)


@contextmanager
def _copy(root: Path) -> Iterator[Store]:
    """Yield the index in memory; empty if there is none that can be read."""
    with closing(sqlite3.connect(":memory:")) as database:
        with suppress(sqlite3.Error, OSError), closing(_reader(root / INDEX)) as original:
            if original.execute("PRAGMA user_version").fetchone()[0] == VERSION:
                original.backup(database)
        _prepare(database)
        yield Store(root, database)


def _reader(file: Path) -> sqlite3.Connection:
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


def _opened(file: Path, *, guarded: bool = True) -> sqlite3.Connection:
    """Return a usable index; a damaged or outdated one is recreated.

    Args:
        file: the index.
        guarded: False where the file system has no locks, which SQLite would need, too.
    """
    for _ in range(2):
        if guarded:
            database = sqlite3.connect(file, timeout=30.0)
        else:
            database = sqlite3.connect(f"{file.resolve().as_uri()}?nolock=1", uri=True)
        try:
            database.execute(f"PRAGMA journal_mode = {'WAL' if guarded else 'DELETE'}")
            database.execute("PRAGMA synchronous = NORMAL")
            if database.execute("PRAGMA user_version").fetchone()[0] not in (0, VERSION):
                raise sqlite3.DatabaseError("another version")
            _prepare(database)
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
    return InputError(
        f"{file}: no space left on device; free some, and the same command goes on where it was"
        if full
        else f"{file}: cannot be written: {error}"
    )


def _prepare(database: sqlite3.Connection) -> None:
    database.execute("PRAGMA foreign_keys = ON")
    database.executescript(_TABLES)
    database.execute(f"PRAGMA user_version = {VERSION}")
    database.commit()


class Store:
    """An open index."""

    def __init__(self, root: Path, database: sqlite3.Connection) -> None:
        self._root, self._database = root, database
        self._file = root / INDEX
        self._damaged: list[DamagedRun] = []
        database.row_factory = sqlite3.Row

    def synchronise(self) -> None:
        """Add new or changed runs and remove deleted ones; unchanged runs are not read.

        A damaged run is removed, and reported with the results.
        """
        self._damaged = []
        found = dict(self._whole(_scan(self._root)))
        for table in ("runs", "failures"):
            there = {d: s for d, s in found.items() if d.endswith(SUFFIX) == (table == "failures")}
            known = dict(self._database.execute(f"SELECT directory, stamp FROM {table}").fetchall())
            with self._writing():
                for directory in known.keys() - there.keys():
                    self._database.execute(f"DELETE FROM {table} WHERE directory = ?", [directory])
                for directory, stamp in there.items():
                    if known.get(directory) != stamp:
                        self._insert(directory, stamp)

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Write all or nothing.

        Raises:
            InputError: the disk is full, or the file cannot be written for another reason.
        """
        try:
            with self._database:
                yield
        except sqlite3.OperationalError as error:
            raise unwritable(self._file, error) from error

    def add(self, directory: str) -> None:
        """Add a new run and remove its failure, if any."""
        stamp = _stamp_of_run(self._root / directory)
        with self._writing():
            failure = directory + SUFFIX
            self._database.execute("DELETE FROM failures WHERE directory = ?", [failure])
            self._insert(directory, stamp)

    def add_failure(self, directory: str) -> None:
        """Add a run that could not be made."""
        with self._writing():
            self._insert(directory + SUFFIX, _stamp(self._root / (directory + SUFFIX)))

    def rows(self) -> StoredRows:
        """Return everything, in the documented order."""
        order = "ORDER BY suite, position, scenario, planner, seed"
        runs = self._database.execute(f"SELECT * FROM runs {order}").fetchall()
        ids = {row["directory"]: row["run_id"] for row in runs}
        scores: dict[str, list[ScoreRow]] = {d: [] for d in ids}
        query = f"SELECT directory, {', '.join(_SCORE)} FROM scores"
        for row in self._database.execute(f"{query} ORDER BY directory, metric, variant, row"):
            directory, *cells = row  # by position: there are hundreds of thousands
            named = dict(zip(_SCORE, cells, strict=True))
            scores[directory].append(ScoreRow(run_id=ids[directory], **named))
        failures = self._database.execute(f"SELECT * FROM failures {order}").fetchall()
        return StoredRows(
            runs=tuple(_run(row) for row in runs),
            scores=tuple(s for directory in ids for s in scores[directory]),
            failures=tuple(_failure(row) for row in failures),
            damaged=tuple(self._damaged),
        )

    def _whole(self, found: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
        """Yield the found runs without those that lack a file."""
        for directory, stamp in found:
            if stamp:
                yield directory, stamp
            else:
                reason = f"{files.RECORD} is missing"
                self._damaged.append(DamagedRun(directory=directory, reason=reason))

    def _insert(self, directory: str, stamp: str) -> None:
        if directory.endswith(SUFFIX):
            self._insert_failure(directory, stamp)
            return
        run = self._root / directory
        self._database.execute("DELETE FROM runs WHERE directory = ?", [directory])
        if not (run / files.RECORD).exists():
            return  # replaced at this moment; the next scan finds it
        try:
            row, rows = _read_row(run, directory), read_scores_csv(run / files.SCORES)
            _check_rows(run / files.SCORES, row, rows)
        except InputError as error:
            reason = str(error).removeprefix(f"{run}/")
            self._damaged.append(DamagedRun(directory=directory, reason=reason))
            return
        self._put("runs", {"stamp": stamp, **_columns(row)})
        self._database.executemany(
            _INSERT_SCORE,
            ((directory, number, *_cells(row.score)) for number, row in enumerate(rows)),
        )

    def _insert_failure(self, directory: str, stamp: str) -> None:
        failure = read_failure(self._root / directory)
        self._database.execute("DELETE FROM failures WHERE directory = ?", [directory])
        if failure is not None:
            values = {n: getattr(failure, n) for n in _FAILURE}
            values["axes"] = json.dumps(values["axes"])
            self._put("failures", {"directory": directory, "stamp": stamp, **values})

    def _put(self, table: str, values: dict[str, Any]) -> None:
        names = ", ".join(values)
        marks = ", ".join("?" * len(values))
        self._database.execute(
            f"INSERT INTO {table} ({names}) VALUES ({marks})", [*values.values()]
        )


_SCORE = (
    "category", "metric", "symbol", "variant", "value", "unit", "better", "status", "reason",
    "lower", "upper",
)  # fmt: skip
_INSERT_SCORE = (
    f"INSERT INTO scores (directory, row, {', '.join(_SCORE)}) "
    f"VALUES ({', '.join('?' * (2 + len(_SCORE)))})"
)
_cells = attrgetter(*_SCORE)
_FAILURE = ("suite", "scenario", "position", "planner", "seed", "axes", "error", "traceback")


def _scan(root: Path) -> Iterator[tuple[str, str]]:
    """Yield runs and failures below a root with their stamps, without calibration runs."""
    for folder, below, names in os.walk(root):
        here = Path(folder)
        if files.RECORD in names:
            below.clear()
            try:
                yield here.relative_to(root).as_posix(), _stamp_of_run(here)
            except OSError:  # replaced at this moment, or a broken link
                if (here / files.RECORD).is_symlink():
                    yield here.relative_to(root).as_posix(), ""
            continue
        if files.RECORDING in names or files.SCORES in names:
            below.clear()
            yield here.relative_to(root).as_posix(), ""
            continue
        if here == root:
            below[:] = [b for b in below if b != "references"]
        below[:] = sorted(b for b in below if ".partial" not in b and ".old-" not in b)
        for name in names:
            run = here / name.removesuffix(SUFFIX)
            if name.endswith(SUFFIX) and not (run / files.RECORD).exists():
                with suppress(OSError):
                    yield (here / name).relative_to(root).as_posix(), _stamp(here / name)


def _stamp(file: Path) -> str:
    about = file.stat()
    return f"{about.st_mtime_ns} {about.st_size} {about.st_ino}"


def _stamp_of_run(run: Path) -> str:
    """Return a stamp that changes with each of its files; the time of a change cannot be set."""
    parts = [_stamp(run / files.RECORD)]
    for name in (files.RECORDING, files.SCORES, files.SCENARIO):
        try:
            about = (run / name).stat()
            parts.append(f"{about.st_size} {about.st_ctime_ns}")
        except OSError:
            parts.append("-")
    return " ".join(parts)


def _read_row(run: Path, directory: str) -> RunRow:
    """The row of a run.

    Raises:
        InputError: a part is missing, truncated or malformed.
    """
    document = files.checked_record(run)
    files.check_whole(run, document)
    return RunRow(record=RunRecord.parse(document, files.RECORD), directory=directory)


def _columns(row: RunRow) -> dict[str, Any]:
    """The columns of a run."""
    return {
        **{name: getattr(row, name) for name in RUN_COLUMNS},
        "position": row.record.position,
        "axes": json.dumps(row.axes),
        "conditions": json.dumps(row.conditions),
        "record": json.dumps(row.record.document()),
    }


def _check_rows(file: Path, run: RunRow, rows: Sequence[RunScore]) -> None:
    """Check that scores belong to a run, without duplicates.

    Raises:
        InputError: they are not.
    """
    own = (safe_cell(run.scenario), safe_cell(run.planner), run.seed)
    seen = set[tuple[str, str]]()
    for row in rows:
        name = row.score.metric, row.score.variant
        if (row.scenario, row.planner, row.seed) != own:
            other = f"{row.scenario[:100]} {row.planner[:60]} seed {row.seed}"
            raise InputError(f"{file}: a score of another run: {other}")
        if name in seen:
            raise InputError(f"{file}: {'.'.join(name)[:100]} is there twice")
        seen.add(name)


def _run(row: sqlite3.Row) -> RunRow:
    record = RunRecord.model_validate_json(row["record"])
    return RunRow(record=record, directory=row["directory"])


def _failure(row: sqlite3.Row) -> Failure:
    values = {name: row[name] for name in _FAILURE if name != "position"}
    return Failure(**{**values, "axes": json.loads(row["axes"])})
