"""Text files that come from outside: read with limits, suggested when a name is misspelt."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

from crowdbot.errors import did_you_mean, nearest

#: Largest text file of a run, bytes.
LARGEST = 64 << 20


def read_text(file: Path) -> str:
    """Return the text of a regular file of at most `LARGEST` bytes.

    Pipes and devices are refused before anything is read from them, so this never blocks.

    Raises:
        OSError: the file is not a regular one, is too large, or cannot be read.
        ValueError: it is not UTF-8.
    """
    with os.fdopen(os.open(file, os.O_RDONLY | os.O_NONBLOCK), "rb") as content:
        about = os.fstat(content.fileno())
        if not stat.S_ISREG(about.st_mode):
            raise OSError(errno.EINVAL, "not a plain file", str(file))
        if about.st_size > LARGEST:
            raise OSError(errno.EFBIG, f"{about.st_size} bytes; {LARGEST} are allowed", str(file))
        return content.read().decode()


def suggest_files(path: Path) -> str:
    """Return ``"; did you mean 'a.csv'?"`` with files beside a missing path, or an empty text."""
    try:
        names = [other.name for other in path.parent.iterdir() if other.is_file()]
    except OSError:
        return ""
    return did_you_mean([str(path.parent / name) for name in nearest(path.name, names)])
