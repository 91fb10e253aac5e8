"""Planners' files, such as weights, stored once beside the runs that used them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from crowdbot.core.planning.files_of_spec import KEPT
from crowdbot.core.support.atomic_write import atomic_path
from crowdbot.dsl.text.bounded_files import open_file
from crowdbot.errors import InputError

#: Folder below the root of the run directories.
FOLDER = "planner_files"
_CHUNK = 1 << 20


def keep_planner_files(root: Path, files: Mapping[str, Path]) -> None:
    """Copy files below the root of the run directories, named by their content.

    Args:
        root: of the run directories.
        files: SHA-256 -> file.

    Raises:
        InputError: one cannot be read or written.
    """
    for digest, file in files.items():
        target = kept_file(root, digest)
        if target.is_file():
            continue
        try:
            with open_file(file) as source, atomic_path(target) as part, part.open("wb") as out:
                while chunk := source.read(_CHUNK):
                    out.write(chunk)
        except OSError as error:
            raise InputError(f"{file}: cannot be kept: {error.strerror or error}") from None


def kept_file(root: Path, digest: str) -> Path:
    """Return the path of the stored file with some SHA-256."""
    return root / FOLDER / f"{digest}{KEPT}"


def digests_of_files(planner: Mapping[str, Any], depth: int = 4) -> Iterator[tuple[str, str]]:
    """Yield name and SHA-256 of each file that a planner of a record, or its fleet, reads.

    Args:
        planner: as in ``run.json``: parameters that name files are mappings with both.
        depth: levels of planners within planners.
    """
    for value in planner.values():
        if isinstance(value, Mapping) and set(value) == {"path", "sha256"}:
            yield str(value["path"]), str(value["sha256"])
        elif isinstance(value, Mapping) and depth:  # of a robot, or one that it uses
            yield from digests_of_files(value, depth - 1)
