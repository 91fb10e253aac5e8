"""Shared memory for scans and images, read-only for planner processes."""

from __future__ import annotations

import fcntl
import mmap
import os
import resource
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Smaller arrays are sent in the message, bytes; so are those for which there is no place left.
SMALLEST, LARGEST = 1024, 1 << 28
_ALIGN = 64
#: Linux: from now on no process may change the size, the seals, or write through its own mapping.
_SEALS = 0x0001 | 0x0002 | 0x0004 | 0x0010
_F_ADD_SEALS = 1033


class SharedMemory:
    """One block of memory, created and sealed before the planner's process starts.

    Otherwise the planner could truncate or seal it first. Unused pages take no memory. Each place
    belongs to one array of one sensor. The planner's side copies arrays, since the next reading
    overwrites them.
    """

    def __init__(self) -> None:
        self.descriptor = os.memfd_create("crowdbot-planner", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
        try:
            self._largest = _largest()
            os.ftruncate(self.descriptor, self._largest)
            self._block = mmap.mmap(self.descriptor, self._largest)
            fcntl.fcntl(self.descriptor, _F_ADD_SEALS, _SEALS)
        except BaseException:
            os.close(self.descriptor)
            raise
        self._places: dict[tuple[str, str], int] = {}
        self._views: dict[tuple[str, str], tuple[NDArray[Any], dict[str, Any]]] = {}
        self._size = 0

    def place(self, sensor: str, part: str, size: int) -> None:
        """Reserve a place for an array of this many bytes; small ones get none."""
        aligned = -(-size // _ALIGN) * _ALIGN
        if size >= SMALLEST and self._size + aligned <= self._largest:
            self._places[sensor, part] = self._size
            self._size += aligned

    @property
    def size(self) -> int:
        """Return the length of all places together, bytes."""
        return self._size

    def put(self, sensor: str, part: str, array: NDArray[Any]) -> dict[str, Any]:
        """Return an array's entry in a message: its location, or its bytes."""
        known = self._views.get((sensor, part))
        if known is None or known[0].shape != array.shape or known[0].dtype != array.dtype:
            at = self._places.get((sensor, part))
            if at is None:
                return in_message(np.ascontiguousarray(array))
            known = self._views[sensor, part] = self._view(at, array)
        known[0][...] = array
        return known[1]

    def _view(self, at: int, array: NDArray[Any]) -> tuple[NDArray[Any], dict[str, Any]]:
        """Return a writable view of an array's place, and its entry in a message."""
        view = np.frombuffer(self._block, array.dtype, array.size, at).reshape(array.shape)
        layout = {"dtype": array.dtype.str, "shape": list(array.shape), "offset": at}
        return view, {**layout, "bytes": array.nbytes}

    def close(self) -> None:
        """Free the block."""
        os.close(self.descriptor)
        self._views.clear()  # they reference the block
        self._block.close()


def _largest() -> int:
    """Return the size of a block; a user's limit of the size of files holds for it, too."""
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)[0]
    return LARGEST if limit == resource.RLIM_INFINITY else min(LARGEST, max(limit, mmap.PAGESIZE))


def in_message(array: NDArray[Any]) -> dict[str, Any]:
    """Return an array's message entry with its bytes."""
    return {"dtype": array.dtype.str, "shape": list(array.shape), "data": array.tobytes()}


def has_shared_memory() -> bool:
    """Return True if this system can make memory read-only for a planner."""
    return sys.platform == "linux" and hasattr(os, "memfd_create")
