"""Texts out of folders that somebody else filled."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

#: Bytes of the largest text that belongs to a run.
LARGEST = 64 << 20


def plain_text(file: Path) -> str:
    """The text of a plain file of at most `LARGEST` bytes.

    Nobody waits for a pipe, or reads a device to its end.

    Raises:
        OSError: there is another kind of thing, or it cannot be read.
        ValueError: it is not UTF-8.
    """
    with os.fdopen(os.open(file, os.O_RDONLY | os.O_NONBLOCK), "rb") as content:
        about = os.fstat(content.fileno())
        if not stat.S_ISREG(about.st_mode):
            raise OSError(errno.EINVAL, "not a plain file", str(file))
        if about.st_size > LARGEST:
            raise OSError(errno.EFBIG, f"{about.st_size} bytes; {LARGEST} are allowed", str(file))
        return content.read().decode()
