"""results.sqlite: an index of the run directories below a root, which can always be rebuilt.

The directories are authoritative. One process at a time, a campaign with ``results.lock``, writes
the index; readers update a copy in memory and write nothing.
"""

from __future__ import annotations

import json
import logging
import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from crowdbot.core.results.failure import SUFFIX, Failure, read_failure
from crowdbot.core.results.index_file import INDEX, VERSION, opened, prepare, reader, unwritable
from crowdbot.core.results.indexed_rows import Texts, read_all, row_of
from crowdbot.core.results.rows import DamagedRun, RunRow, ScoreRow
from crowdbot.core.results.scan import Scan, stamp_of, stamp_of_run
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.scores_csv import RunScore, read_scores_csv, safe_cell
from crowdbot.core.support.locks import try_lock
from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")
LOCK = "results.lock"

#: Number of new or changed runs from which on a reader renews the index, if it may.
RENEWED_FROM = 200


class StoredRows(NamedTuple):
    """Everything below a root: runs in the documented order, scores by run, and failures."""

    runs: tuple[RunRow, ...]
    scores: Sequence[ScoreRow]
    failures: tuple[Failure, ...]
    damaged: tuple[DamagedRun, ...]


def read_rows(root: Path) -> StoredRows:
    """Return all current runs, scores and failures below a root.

    The index is renewed if many runs are new to it and nothing prevents that; nothing else is
    written. A damaged run is left out, with a warning.

    Raises:
        InputError: there is no such folder.
    """
    if not root.is_dir():
        raise InputError(f"{root}: no folder of results; 'crowdbot campaign' makes one")
    scan = Scan.of(root)
    rows = _as_it_is(root, scan) or _renewed(root, scan) or _in_memory(root, scan)
    for run in rows.damaged:
        _LOG.warning("warning: %s is left out: %s", root / run.directory, run.reason)
    return rows


def _as_it_is(root: Path, scan: Scan) -> StoredRows | None:
    """Return the rows of the index if it has every run as it is now."""
    file = root / INDEX
    if not file.is_file() or file.with_name(f"{file.name}-wal").exists():
        return None
    address = f"{file.resolve().as_uri()}?immutable=1"
    with suppress(sqlite3.Error, OSError), closing(sqlite3.connect(address, uri=True)) as database:
        if database.execute("PRAGMA user_version").fetchone()[0] == VERSION:
            store = Store(root, database)
            return store.rows(scan) if store.changed(scan) == 0 else None
    return None


def _renewed(root: Path, scan: Scan) -> StoredRows | None:
    """Return the rows of the index after renewing it; None if that is not possible or worth it."""
    with _copy(root) as store:
        if store.changed(scan) < RENEWED_FROM:
            return None
    if not os.access(root, os.W_OK):
        return None
    try:
        with index(root) as store:
            store.synchronise(scan)
            return store.rows(scan)
    except InputError:  # another process is writing it, or there is no space
        return None


def _in_memory(root: Path, scan: Scan) -> StoredRows:
    with _copy(root) as store:
        store.synchronise(scan)
        return store.rows(scan)


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
        with closing(opened(root / INDEX, guarded=state == "locked")) as database:
            yield Store(root, database)
    finally:
        os.close(handle)


@contextmanager
def _copy(root: Path) -> Iterator[Store]:
    """Yield the index in memory; empty if there is none that can be read."""
    with closing(sqlite3.connect(":memory:")) as database:
        with suppress(sqlite3.Error, OSError), closing(reader(root / INDEX)) as original:
            if original.execute("PRAGMA user_version").fetchone()[0] == VERSION:
                original.backup(database)
        prepare(database)
        yield Store(root, database)


class Store:
    """An open index of run directories, ``results.sqlite``."""

    def __init__(self, root: Path, database: sqlite3.Connection) -> None:
        self._root, self._database = root, database
        self._file = root / INDEX
        self._texts = Texts(database)

    def changed(self, scan: Scan) -> int:
        """Return the number of runs and failures that are new, changed or gone."""
        there, known = scan.there, self._known()
        return sum(known.get(d) != s for d, s in there.items()) + len(known.keys() - there.keys())

    def synchronise(self, scan: Scan | None = None) -> None:
        """Add new or changed runs and remove deleted ones; unchanged runs are not read.

        A damaged run is removed, and reported with the results.

        Args:
            scan: what is there, if that is known.
        """
        there, known = (scan or Scan.of(self._root)).there, self._known()
        with self._writing():
            for directory in known.keys() - there.keys():
                self._forget(directory)
            for directory, stamp in there.items():
                if known.get(directory) != stamp:
                    self._insert(directory, stamp)

    def _known(self) -> dict[str, str]:
        """Return the runs and failures of the index, with their stamps."""
        found: dict[str, str] = {}
        for table in ("runs", "failures", "damaged"):
            found |= dict(self._database.execute(f"SELECT directory, stamp FROM {table}"))
        return found

    def _forget(self, directory: str) -> None:
        for table in ("runs", "failures", "damaged"):
            self._database.execute(f"DELETE FROM {table} WHERE directory = ?", [directory])

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Open a transaction: all changes are written, or none.

        Raises:
            InputError: the disk is full, or the file cannot be written for another reason.
        """
        try:
            with self._database:
                yield
        except BaseException as error:
            self._texts = Texts(self._database)  # what it added last is gone
            if isinstance(error, sqlite3.OperationalError):
                raise unwritable(self._file, error) from error
            raise

    def add(self, directory: str) -> None:
        """Add a new run and remove its failure, if any."""
        stamp = stamp_of_run(self._root / directory)
        with self._writing():
            self._forget(directory + SUFFIX)
            self._insert(directory, stamp)

    def add_failure(self, directory: str) -> None:
        """Add a run that could not be made."""
        with self._writing():
            self._insert(directory + SUFFIX, stamp_of(self._root / (directory + SUFFIX)))

    def rows(self, scan: Scan | None = None) -> StoredRows:
        """Return everything, in the documented order, with the damaged runs that ``scan`` found."""
        order = "ORDER BY suite, position, scenario, planner, seed"
        runs, scores = read_all(self._database, order)
        columns = ", ".join(_FAILURE)
        failures = self._database.execute(f"SELECT {columns} FROM failures {order}").fetchall()
        damaged = self._database.execute("SELECT directory, reason FROM damaged").fetchall()
        left_out = [DamagedRun(directory=d, reason=why) for d, why in damaged]
        left_out += scan.missing if scan else ()
        return StoredRows(
            runs=runs,
            scores=scores,
            failures=tuple(_failure(row) for row in failures),
            damaged=tuple(sorted(left_out, key=lambda d: d.directory)),
        )

    def _insert(self, directory: str, stamp: str) -> None:
        self._forget(directory)
        if directory.endswith(SUFFIX):
            self._insert_failure(directory, stamp)
            return
        run = self._root / directory
        if not os.path.lexists(run / files.RECORD):
            return  # replaced at this moment; the next scan finds it
        try:
            row, rows = _read_row(run, directory), read_scores_csv(run / files.SCORES)
            _check_rows(run / files.SCORES, row, rows)
        except InputError as error:
            reason = str(error).removeprefix(f"{run}/")
            self._put("damaged", {"directory": directory, "stamp": stamp, "reason": reason})
            return
        columns = row_of(row, [one.score for one in rows], self._texts)
        self._put("runs", {"stamp": stamp, **columns})

    def _insert_failure(self, directory: str, stamp: str) -> None:
        failure = read_failure(self._root / directory)
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


_FAILURE = ("suite", "scenario", "position", "planner", "seed", "axes", "error", "traceback")


def _read_row(run: Path, directory: str) -> RunRow:
    """Return the row of a run.

    Raises:
        InputError: a part is missing, truncated or malformed.
    """
    document = files.checked_record(run)
    files.check_whole(run, document)
    return RunRow(record=RunRecord.parse(document, files.RECORD), directory=directory)


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


def _failure(row: Sequence[Any]) -> Failure:
    values = dict(zip(_FAILURE, row, strict=True))
    del values["position"]
    return Failure(**{**values, "axes": json.loads(values["axes"])})
