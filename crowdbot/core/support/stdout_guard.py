"""Keeps standard output to what a command answers, whatever plugins print meanwhile."""

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
    """Send to stderr what is printed to stdout: by Python, by compiled code, by child processes.

    For commands, not for libraries: file descriptor 1 belongs to the whole process.
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
    """Let descriptor 1 lead where 2 leads; the old one, or None where one of them is closed."""
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
    """Write out what waits in buffers of Python and of C, while it still goes to stderr."""
    for stream in (sys.__stdout__, sys.stdout):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()  # type: ignore[union-attr]
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).fflush(None)
