"""Exit without a final garbage collection."""

from __future__ import annotations

import atexit
import gc
import io

_WRITERS = (io.TextIOWrapper, io.BufferedWriter, io.BufferedRandom)


def end_without_collecting() -> None:
    """Make this process exit without a final garbage collection.

    Otherwise Python's cyclic collector walks all objects several times at exit: with Drake and
    numba hundreds of thousands, which takes a quarter of a short command's processor time. Written
    data is flushed, even in files that a plugin left open. Use only in our own processes: a host of
    crowdbot's Python API may rely on its finalisers.
    """
    atexit.unregister(_end)
    atexit.register(_end)


def _end() -> None:
    for thing in gc.get_objects():
        if issubclass(type(thing), _WRITERS):
            _flush(thing)
    gc.freeze()


def _flush(file: io.IOBase) -> None:
    try:
        file.flush()
    except (OSError, ValueError):  # disk full, reader gone, or closed
        return
