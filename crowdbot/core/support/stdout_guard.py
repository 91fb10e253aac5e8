"""Keep plugins' output away from the command's standard output."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_OUT, _ERR = 1, 2


@contextmanager
def stdout_to_stderr() -> Iterator[None]:
    """Send output to stdout to stderr instead: from Python, compiled code and child processes.

    For commands, not libraries: file descriptor 1 belongs to the whole process.
    """
    sys.stdout.flush()
    kept = _redirected()
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        _flush()
        if kept is not None:
            os.dup2(kept, _OUT)
            os.close(kept)


def _redirected() -> int | None:
    """Redirect descriptor 1 to 2; return the old one, or None if one of them is closed."""
    try:
        kept = os.dup(_OUT)
    except OSError:
        return None
    try:
        os.dup2(_ERR, _OUT)
    except OSError:
        os.close(kept)
        return None
    return kept


def _flush() -> None:
    """Flush the buffers of Python and C while they still go to stderr."""
    for stream in (sys.__stdout__, sys.stdout):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()  # type: ignore[union-attr]
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).fflush(None)
