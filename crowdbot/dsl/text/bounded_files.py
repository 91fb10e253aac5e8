"""Read text files of limited size, and plain files of any size."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import BinaryIO

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.errors import SpecError

MAX_BYTES = 1_000_000


def read_text(path: Path, name: str) -> str:
    """Return the text of a file: UTF-8 with or without a byte order mark, any line ends.

    Raises:
        SpecError: E001, there is no such file or it is not a text of reasonable size.
    """
    try:
        with open_file(path) as file:
            raw = file.read(MAX_BYTES + 1)
    except IsADirectoryError:
        raise _unreadable(name, "is a folder, not a file") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        reason = "no such file" if isinstance(error, FileNotFoundError) else reason
        raise _unreadable(name, reason) from None
    if len(raw) > MAX_BYTES:
        raise _unreadable(name, f"is larger than {MAX_BYTES // 1_000_000} MB")
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise _unreadable(name, "is UTF-16; save it as UTF-8")
    if b"\0" in raw:
        raise _unreadable(name, "is a binary file")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise _unreadable(name, f"is not UTF-8 (line {line}); save it as UTF-8") from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def open_file(path: Path) -> BinaryIO:
    """Open a plain file for reading.

    Raises:
        OSError: it cannot be opened, or is something else, such as a pipe.
    """
    file = open(path, "rb", opener=_without_waiting)  # noqa: SIM115 - the caller closes it
    if stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        return file
    file.close()
    raise OSError("is a device or pipe, not a file")


def _without_waiting(path: str, flags: int) -> int:
    """Open without blocking, since a pipe without a writer would block forever."""
    return os.open(path, flags | os.O_NONBLOCK)


def _unreadable(name: str, why: str) -> SpecError:
    return SpecError([Diagnostic("E001", why, Mark(Source(name)))])
