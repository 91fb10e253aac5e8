"""Files that commands write: complete under their final name, or not there."""

from __future__ import annotations

from pathlib import Path

from crowdbot.errors import InputError


def write_file(path: Path, content: bytes) -> None:
    """Write aside, then rename.

    Raises:
        InputError: the path cannot be written; nothing is left behind.
    """
    aside = path.with_name(f"{path.name}.part")
    try:
        aside.write_bytes(content)
        aside.replace(path)
    except OSError as error:
        aside.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
