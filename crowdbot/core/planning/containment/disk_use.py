"""Limit of the disk space that a planner may use in its folder.

Uses only the standard library.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

#: Most bytes and files of a planner's folder. The rest of the file system is looked at first, which
#: costs one system call: only if it has shrunk by a quarter of that is the folder gone through.
MOST_BYTES, MOST_FILES = 4 << 30, 100_000
_SHARE = 4
#: Longest path that is looked at: longer ones cannot be opened by name.
_LONGEST = 3000
_BLOCK = 512


class DiskUse:
    """Watches how much of its file system a folder takes since the planner began.

    Args:
        folder: the planner's; empty if it has none.
    """

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._bytes, self._files = _free(folder)

    def excess(self) -> str:
        """Return how the folder exceeds its limit; empty if it does not."""
        free_bytes, free_files = _free(self._folder)
        shrunk = self._bytes - free_bytes > MOST_BYTES // _SHARE
        if not shrunk and self._files - free_files <= MOST_FILES // _SHARE:
            self._bytes, self._files = max(self._bytes, free_bytes), max(self._files, free_files)
            return ""
        found = _too_much(self._folder)
        if not found:
            self._bytes, self._files = free_bytes, free_files  # others took it
        return found


def _too_much(folder: str) -> str:
    """Describe how a folder exceeds its limit, or why that is unknown; empty if it does not."""
    used, count = 0, 0
    for path, state in _states(folder):
        if state is None or len(path) > _LONGEST:
            return "it made folders that cannot be looked into"
        used, count = used + _BLOCK * state.st_blocks, count + 1
        if used > MOST_BYTES:
            return f"it wrote more than {MOST_BYTES >> 30} GiB to its folder"
        if count > MOST_FILES:
            return f"it made more than {MOST_FILES} files in its folder"
    return ""


def _free(folder: str) -> tuple[int, int]:
    """Return the free bytes and files of a folder's file system."""
    try:
        state = os.statvfs(folder)
    except OSError:
        return 0, 0
    return state.f_bavail * state.f_frsize, state.f_favail


def _states(folder: str) -> Iterator[tuple[str, os.stat_result | None]]:
    """Yield path and state of everything in a folder; None for unreadable entries."""
    waiting = [folder]
    while waiting:
        place = waiting.pop()
        try:
            with os.scandir(place) as found:
                for one in found:
                    yield one.path, one.stat(follow_symlinks=False)
                    if one.is_dir(follow_symlinks=False):
                        waiting.append(one.path)
        except FileNotFoundError:
            continue  # the planner has removed it meanwhile
        except OSError:
            yield place, None
