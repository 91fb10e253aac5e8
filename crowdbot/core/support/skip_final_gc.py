"""A process that ends without looking through everything that libraries have made."""

from __future__ import annotations

import atexit
import gc
import io

_WRITERS = (io.TextIOWrapper, io.BufferedWriter, io.BufferedRandom)


def end_without_collecting() -> None:
    """Have this process leave its memory to the operating system when it ends.

    Python's collector of cycles otherwise walks all objects several times at the end: with Drake
    and numba these are hundreds of thousands, and a quarter of the processor time of a short
    command. What was written into files is kept, also where a plugin left one open. For processes
    that are ours alone: a host of crowdbot's Python API may count on its own finalisers.
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
    except (OSError, ValueError):  # its disk is full, its reader has gone, or it is closed
        return


__all__ = ["end_without_collecting"]
