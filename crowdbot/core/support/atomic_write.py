"""Atomic file writes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from crowdbot.errors import InputError


@contextmanager
def atomic_path(path: Path) -> Iterator[Path]:
    """Yield a temporary path, renamed to ``path`` at the end, deleted on failure.

    Missing parent folders are created.

    Raises:
        InputError: the path cannot be written.
    """
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        if not path.parent.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
        part.touch()  # report an unwritable path before the work, by its final name
        yield part
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        with suppress(OSError):
            part.unlink()


def atomic_write(path: Path, content: str | bytes) -> None:
    """Write a file under a temporary name, then rename it; nothing is left on failure.

    Raises:
        InputError: the path cannot be written.
    """
    data = content.encode() if isinstance(content, str) else content
    with atomic_path(path) as part:
        part.write_bytes(data)


def atomic_parts(path: Path, parts: Iterable[bytes]) -> None:
    """Write the parts of a file as `atomic_write` does, without keeping them in memory.

    Raises:
        InputError: the path cannot be written.
    """
    # Emptied, the file would be sent to the disk when it is closed.
    with atomic_path(path) as part, part.open("r+b") as file:
        file.writelines(parts)
        file.truncate()  # what a process of the same number left, if any
