"""Copies of the files that a site links to: the suite with its files, and the bundles."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from crowdbot.core.bundle.entries import LeaderboardEntry
from crowdbot.core.bundle.standings import Standings
from crowdbot.core.registry.registry import Registry
from crowdbot.core.scenarios.library import open_document
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.suite.asset_files import asset_hashes
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError

SUITE, BUNDLES = "suite", "bundles"


def copy_suite(
    spec: str, expansion: Expansion, lock: LockFiles, registry: Registry, folder: Path
) -> list[str]:
    """Copy a suite's file, its base documents, other files and lock, into ``suite/``.

    Returns:
        The copies relative to the folder, the suite first; none for a packaged suite.

    Raises:
        InputError: one cannot be copied.
    """
    if not Path(spec).is_file():
        return []
    document = open_document(spec, registry)
    top = document.path.parent
    named = [top / path for path in asset_hashes(expansion.scenarios) if ":" not in path]
    locked = [lock.lock_path, lock.agents_path] if lock.lock_path.exists() else []
    found = dict.fromkeys([document.path, *document.suite.included, *named, *locked])
    inside = [p for p in found if p.is_file() and p.resolve().is_relative_to(top.resolve())]
    names = [f"{SUITE}/{p.resolve().relative_to(top.resolve()).as_posix()}" for p in inside]
    for path, name in zip(inside, names, strict=True):
        _copy(path, folder / name)
    return names


def with_copies(tables: Sequence[Standings], folder: Path) -> list[Standings]:
    """Copy the bundles of tables into ``bundles/``, and return tables of the copies.

    Raises:
        InputError: one cannot be copied.
    """

    def copied(entry: LeaderboardEntry) -> LeaderboardEntry:
        target = folder / BUNDLES / entry.path.name
        _copy(entry.path, target)
        return replace(entry, path=target)

    return [replace(t, entries=tuple(copied(e) for e in t.entries)) for t in tables]


def _copy(path: Path, target: Path) -> None:
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if not (target.exists() and target.samefile(path)):
            shutil.copy2(path, target)  # with its time, which says if a bundle is late
    except OSError as error:
        raise InputError(f"{target}: cannot be written: {error.strerror or error}") from None
