"""Files of compiled functions that are checked before they are read.

Numba unpickles them, and the simulator runs what they hold. A file that was cut, exchanged or
changed by accident is compiled again, and so is one that another user owns or may write. It cannot
be changed by a planner: a planner's process may not write there.
"""
# Numba has no types of its own. What is overridden here is not in its documentation.
# mypy: disable-error-code="misc,no-untyped-call,attr-defined"

from __future__ import annotations

import hashlib
import os
import pickle
import stat
import sys
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

from numba.core import caching

_LENGTH = 16
#: Largest file that is read, bytes.
_LARGEST = 1 << 28
_OF_OTHERS = stat.S_IWGRP | stat.S_IWOTH
#: Folders whose damaged files were reported.
_REPORTED: set[str] = set()


class CheckedCacheFile(caching.IndexDataCacheFile):
    """Numba's index and data files of one function.

    The index ends in a digest of itself and of its name, and has the digest of each data file: no
    file passes for another one, or for one of an earlier time. Data are written before the index,
    so that a process may be ended in between.
    """

    def load(self, key: Any) -> Any:
        """Return a stored entry; None if there is none, or its hash is wrong."""
        try:
            name, digest = self._load_index().get(key, ("", b""))
            return self._entry(name, digest) if name else None
        except _Damaged as damaged:
            _say_damaged(str(Path(self._cache_path).parent), str(damaged))
        except OSError:
            pass
        return None

    def save(self, key: Any, data: Any) -> None:
        """Store an entry, where that can be written; an index that cannot be read is replaced."""
        try:
            entries = self._load_index()
        except (_Damaged, OSError):
            entries = {}
        used = {name for name, _ in entries.values()}
        free = (self._data_name(k) for k in count(1))
        name = entries[key][0] if key in entries else next(n for n in free if n not in used)
        raw = self._dump(data)
        with suppress(OSError):
            self._write(self._data_path(name), raw)
            self._save_index({**entries, key: (name, _digest(raw))})

    def _entry(self, name: str, digest: bytes) -> Any:
        path = self._data_path(name)
        raw = _read(path)
        if _digest(raw) != digest:
            raise _Damaged(path)
        return pickle.loads(raw)  # noqa: S301 - our own, see above

    def _load_index(self) -> Any:
        try:
            raw = _read(self._index_path)
        except FileNotFoundError:
            return {}
        data, digest = raw[:-_LENGTH], raw[-_LENGTH:]
        if data and digest == _digest(data):  # as it was written before it had a name
            return {}
        if digest != self._digest_of_index(data):
            raise _Damaged(self._index_path)
        try:
            version, stamp, entries = pickle.loads(data)  # noqa: S301 - our own, see above
        except (AttributeError, ImportError):  # it names a class that the source had before
            return {}
        same = version == self._version and stamp == self._source_stamp
        return entries if same else {}

    def _save_index(self, overloads: Any) -> None:
        data = self._dump((self._version, self._source_stamp, overloads))
        self._write(self._index_path, data + self._digest_of_index(data))

    def _digest_of_index(self, data: bytes) -> bytes:
        return _digest(self._index_name.encode() + b"\0" + data)

    def _write(self, path: str, raw: bytes) -> None:
        with self._open_for_write(path) as file:
            mode = stat.S_IMODE(os.fstat(file.fileno()).st_mode)
            with suppress(OSError):  # a planner's process may not change modes
                os.fchmod(file.fileno(), mode & ~_OF_OTHERS)
            file.write(raw)


def check_all_cache_files() -> None:
    """Let numba check the files of all functions, those of plugins as well."""
    caching.IndexDataCacheFile = CheckedCacheFile


class _Damaged(Exception):  # noqa: N818 - a state of a file, told by `_say_damaged`
    """A cache file was truncated, changed or exchanged, or other users may write it."""


def _say_damaged(folder: str, file: str) -> None:
    """Print, once for a folder, that compiled functions are damaged and compiled again."""
    if folder not in _REPORTED:
        _REPORTED.add(folder)
        text = "was cut or changed, or is of another version or user; it is compiled again"
        print(f"{file}: {text}, and so are others like it", file=sys.stderr)


def _read(path: str) -> bytes:
    """Return the contents of a plain file of this user, or of root, that no other one may write.

    Raises:
        _Damaged: it is not such a file.
        OSError: it cannot be read.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NONBLOCK)
    about = os.fstat(descriptor)
    plain = stat.S_ISREG(about.st_mode) and about.st_size <= _LARGEST
    if not plain or about.st_uid not in (0, os.geteuid()) or about.st_mode & _OF_OTHERS:
        os.close(descriptor)
        raise _Damaged(path)
    with os.fdopen(descriptor, "rb") as file:
        return file.read()


def _digest(data: bytes) -> bytes:
    return hashlib.blake2b(data, digest_size=_LENGTH).digest()
