"""Files of compiled functions that are checked before they are read.

Numba unpickles them, and the simulator runs what they hold: a file that was cut, or changed by
accident, is compiled again. It cannot be changed by a planner: a planner's process may not write
there.
"""
# Numba has no types of its own. What is overridden here is not in its documentation.
# mypy: disable-error-code="misc,no-untyped-call,attr-defined"

from __future__ import annotations

import hashlib
import pickle
import sys
from pathlib import Path
from typing import Any

from numba.core.caching import IndexDataCacheFile

_LENGTH = 16
#: Folders of which it was said that they hold damaged files.
_SAID: set[str] = set()


class CheckedCacheFile(IndexDataCacheFile):
    """Numba's index and data files, each with a digest at its end."""

    def load(self, key: Any) -> Any:
        """Return a stored entry; None if there is none, or it is damaged or cannot be read."""
        try:
            return super().load(key)
        except _Damaged as damaged:
            _say_damaged(str(Path(self._cache_path).parent), str(damaged))
            return None
        except OSError:
            return None

    def _load_index(self) -> Any:
        try:
            data = _checked(self._index_path)
        except FileNotFoundError:
            return {}
        try:
            version, stamp, overloads = pickle.loads(data)  # noqa: S301 - our own, see above
        except (AttributeError, ImportError):  # it names a class that the source had before
            return {}
        same = version == self._version and stamp == self._source_stamp
        return overloads if same else {}

    def _save_index(self, overloads: Any) -> None:
        self._write(self._index_path, (self._version, self._source_stamp, overloads))

    def _load_data(self, name: str) -> Any:
        return pickle.loads(_checked(self._data_path(name)))  # noqa: S301 - as above

    def _save_data(self, name: str, data: Any) -> None:
        self._write(self._data_path(name), data)

    def save(self, key: Any, data: Any) -> None:
        """Store an entry; a damaged index is replaced."""
        try:
            super().save(key, data)
        except _Damaged:
            self.flush()
            super().save(key, data)

    def _write(self, path: str, content: Any) -> None:
        data = self._dump(content)
        with self._open_for_write(path) as file:
            file.write(data)
            file.write(_digest(data))


class _Damaged(Exception):  # noqa: N818 - a state of a file, told by `_say_damaged`
    """The file was cut or changed."""


def _say_damaged(folder: str, file: str) -> None:
    """Print, once for a folder, that compiled functions are damaged and compiled again."""
    if folder not in _SAID:
        _SAID.add(folder)
        text = "was cut or changed, or is of another version; such functions are compiled again"
        print(f"{file}: {text}", file=sys.stderr)


def _checked(path: str) -> bytes:
    """Return the contents of a file without the digest.

    Raises:
        OSError: it cannot be read.
    """
    raw = Path(path).read_bytes()
    data, digest = raw[:-_LENGTH], raw[-_LENGTH:]
    if digest != _digest(data):
        raise _Damaged(path)
    return data


def _digest(data: bytes) -> bytes:
    return hashlib.blake2b(data, digest_size=_LENGTH).digest()
