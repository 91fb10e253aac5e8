"""Untrusted text files: read with limits; similar names are suggested for missing ones."""

from __future__ import annotations

import re
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
        most: largest size, bytes.
        name: its name for messages; empty: its path.

    Raises:
        InputError: it cannot be read, is not a plain file, too large, or not UTF-8.
    """
    return input_bytes(file, most, name, text=True).decode("utf-8-sig")


def input_bytes(file: Path, most: int = LARGEST, name: str = "", *, text: bool = False) -> bytes:
    """Return the content of a file that the user named.

    Args:
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
        if isinstance(error, UnicodeDecodeError):
            near = _what_it_is(content)
        raise InputError(f"{name or file}: cannot be read: {reason_of(error)}{near}") from None
    if reason := _stands_for(content, text=text):
        raise InputError(f"{name or file}: cannot be read: {reason}")
    return content


#: First bytes of files that are often taken for text -> what helps.
_OTHERS = {
    b"\x1f\x8b": "it is compressed, unpack it with 'gunzip'",
    b"PK": "it is a spreadsheet or a zip archive, export or unpack it",
    b"\xff\xfe": "it is UTF-16, save it as UTF-8",
    b"\xfe\xff": "it is UTF-16, save it as UTF-8",
    b"\x28\xb5\x2f\xfd": "it is compressed, unpack it with 'zstd -d'",
    b"\x89HDF": "it is HDF5, export it as CSV",
    b"SQLite format 3": "it is an SQLite database",
}


def _what_it_is(content: bytes) -> str:
    descriptions = (text for start, text in _OTHERS.items() if content.startswith(start))
    return "; " + next(descriptions, "save it as UTF-8 if it is text")


def _stands_for(content: bytes, *, text: bool) -> str:
    """Return what a file contains in place of the wanted text, or "" if nothing is suspicious."""
    begin = content[:200].removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    if begin.startswith(b"version https://git-lfs"):
        return "it is a pointer of Git LFS; 'git lfs pull' fetches the file"
    if re.match(rb"(?:(?:\.\./)*\.git)?/annex/objects/", begin):
        return "it is a pointer of git-annex; 'git annex get' fetches the file"
    if begin.startswith((b"<!doctype", b"<html")):
        return "it is a web page, perhaps the message of a failed download"
    if text and begin.startswith(b"pk\x03\x04"):
        return "it is a spreadsheet or a zip archive, export or unpack it"
    return ""


def suggest_files(path: Path) -> str:
    """Return ``"; did you mean 'a.csv'?"`` with files beside a missing path, or an empty text."""
    try:
        names = [other.name for other in path.parent.iterdir() if other.is_file()]
    except OSError:
        return ""
    return did_you_mean([str(path.parent / name) for name in nearest(path.name, names)])
