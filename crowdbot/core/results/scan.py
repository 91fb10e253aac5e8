"""Scan: the runs and failures in a folder, with stamps that change when their files do."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from crowdbot.core.results.failure import SUFFIX
from crowdbot.core.results.rows import DamagedRun
from crowdbot.core.runs import run_directory as files


@dataclass(frozen=True, slots=True)
class Scan:
    """Contents of a root.

    Attributes:
        there: directory of a run, or file of a failure -> its stamp.
        missing: runs that have lost their records.
    """

    there: dict[str, str]
    missing: tuple[DamagedRun, ...]

    @staticmethod
    def of(root: Path) -> Scan:
        """List all runs and failures below a root by their files' stamps; no file is opened."""
        found = list(_scan(root))
        reason = f"{files.RECORD} is missing"
        lost = (DamagedRun(directory=d, reason=reason) for d, stamp in found if not stamp)
        return Scan({d: stamp for d, stamp in found if stamp}, tuple(lost))


def _scan(root: Path) -> Iterator[tuple[str, str]]:
    """Yield runs and failures below a root with their stamps, without calibration runs.

    Folders of runs, which are most, are not listed: the files of a run have known names.
    """
    top, waiting = len(str(root)) + 1, [str(root)]
    while waiting:
        folder = waiting.pop()
        place = folder[top:].replace(os.sep, "/") or "."
        if stamp := _stamp_if_run(folder):
            yield place, stamp
            continue
        names, below = _listed(folder)
        if files.RECORD in names:  # replaced at this moment, or a broken link
            if os.path.islink(f"{folder}/{files.RECORD}"):  # noqa: PTH114  as below
                yield place, ""
            continue
        if files.RECORDING in names or files.SCORES in names:
            yield place, ""
            continue
        if folder == str(root):
            below.discard("references")
        kept = (b for b in below if ".partial" not in b and ".old-" not in b)
        waiting += [f"{folder}{os.sep}{b}" for b in sorted(kept, reverse=True)]
        for name in names:
            run = f"{folder}/{name.removesuffix(SUFFIX)}"
            if name.endswith(SUFFIX) and not os.path.exists(f"{run}/{files.RECORD}"):  # noqa: PTH110
                with suppress(OSError):
                    file = f"{folder}{os.sep}{name}"
                    yield file[top:].replace(os.sep, "/"), stamp_of(file)


def _listed(folder: str) -> tuple[list[str], set[str]]:
    """Return the names of files in a folder, and of folders that are not links."""
    names, below = list[str](), set[str]()
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if not _is_folder(entry):
                names.append(entry.name)
            elif not entry.is_symlink():
                below.add(entry.name)
    return names, below


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # a link to itself
        return False


def _stamp_if_run(folder: str) -> str:
    """Return the stamp of a run; empty for a bag or another folder, or if it cannot be read."""
    try:
        about = os.stat(f"{folder}/{files.RECORD}")  # noqa: PTH116  many files: a Path takes longer
        run = not stat.S_ISDIR(about.st_mode) and not files.is_bag(folder)
        return stamp_of_run(folder, about) if run else ""
    except OSError:
        return ""


def stamp_of(file: str | Path, known: os.stat_result | None = None) -> str:
    """Return the stamp of a file, which changes with it; ``known``: its status, if asked for."""
    about = known or os.stat(file)  # noqa: PTH116  many files: a Path takes longer
    return f"{about.st_mtime_ns} {about.st_size} {about.st_ino} {about.st_ctime_ns}"


def stamp_of_run(run: str | Path, known: os.stat_result | None = None) -> str:
    """Return a stamp that changes with each of its files; the time of a change cannot be set.

    Args:
        run: its folder.
        known: the status of its record, if that has been asked for.
    """
    parts = [stamp_of(f"{run}/{files.RECORD}", known)]
    for name in (files.RECORDING, files.SCORES, files.SCENARIO):
        try:
            about = os.stat(f"{run}/{name}")  # noqa: PTH116
            parts.append(f"{about.st_size} {about.st_ctime_ns}")
        except OSError:
            parts.append("-")
    return " ".join(parts)
