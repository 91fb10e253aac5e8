"""Text files that come from outside: read with limits, suggested when a name is misspelt."""

from __future__ import annotations

from pathlib import Path

from crowdbot.dsl.text.bounded_files import read_bytes, reason_of
from crowdbot.errors import InputError, did_you_mean, nearest

#: Largest text file of a run, and largest table or mesh, bytes.
LARGEST, LARGEST_TABLE = 64_000_000, 512_000_000


def read_text(file: Path, most: int = LARGEST) -> str:
    """Return the text of a regular file of at most ``most`` bytes.

    Pipes and devices are refused before anything is read from them, so this never blocks.

    Raises:
        OSError: the file is not a regular one, is too large, or cannot be read.
        ValueError: it is not UTF-8.
    """
    return read_bytes(file, most).decode()


def input_text(file: Path, most: int = LARGEST, name: str = "") -> str:
    """Return the text of a file that the user named, without a byte order mark.

    Args:
        file: the file.
        most: largest size, bytes.
        name: its name for messages; empty: its path.

    Raises:
        InputError: it cannot be read, is not a plain file, too large, or not UTF-8.
    """
    return input_bytes(file, most, name, text=True).decode("utf-8-sig")


def input_bytes(file: Path, most: int = LARGEST, name: str = "", *, text: bool = False) -> bytes:
    """Return the content of a file that the user named.

    Args:
        file: the file.
        most: largest size, bytes.
        name: its name for messages; empty: its path.
        text: True if it has to be UTF-8.

    Raises:
        InputError: it cannot be read, is not a plain file, or too large.
    """
    try:
        content = read_bytes(file, most)
        if text:
            content.decode()
    except (OSError, ValueError) as error:
        near = suggest_files(file) if isinstance(error, FileNotFoundError) else ""
        raise InputError(f"{name or file}: cannot be read: {reason_of(error)}{near}") from None
    return content


def suggest_files(path: Path) -> str:
    """Return ``"; did you mean 'a.csv'?"`` with files beside a missing path, or an empty text."""
    try:
        names = [other.name for other in path.parent.iterdir() if other.is_file()]
    except OSError:
        return ""
    return did_you_mean([str(path.parent / name) for name in nearest(path.name, names)])
