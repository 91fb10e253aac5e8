"""A file that this process writes and hashes, to detect changes by other processes."""

from __future__ import annotations

import hashlib
import os
import stat
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True)
class Written:
    """A complete file, as this process wrote it.

    Attributes:
        device, inode: of the file that was opened.
        sha256: of its contents.
        before: SHA-256 of the contents before the `mark`.
    """

    device: int
    inode: int
    sha256: str
    before: Any = field(repr=False)

    def check(self, path: Path) -> None:
        """Check that the file is still what was written.

        Raises:
            InputError: another process has replaced or changed it.
        """
        try:
            handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_CLOEXEC)
            with os.fdopen(handle, "rb") as file:
                there = os.fstat(handle)
                same = (there.st_dev, there.st_ino) == (self.device, self.inode)
                same = same and hashlib.file_digest(file, "sha256").hexdigest() == self.sha256
        except OSError:
            same = False
        if not same:
            raise InputError(
                f"{path}: is not what the simulator wrote: another process changed or replaced it "
                "during the run, which therefore has no scores"
            )

    def with_ending(self, ending: bytes) -> str:
        """Return the SHA-256 of the file if the part after the mark is replaced."""
        whole = self.before.copy()
        whole.update(ending)
        return str(whole.hexdigest())


class OwnFile:
    """An unbuffered file for writing; errors name it. After an error, each call raises it again.

    Args:
        path: an existing file is replaced.

    Raises:
        InputError: it cannot be written, also in all methods.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._size = path, 0
        self._sha: Any = hashlib.sha256()
        self._mark: Any = self._sha
        self._failure: InputError | None = None
        try:
            self._file = path.open("wb", buffering=0)
        except OSError as error:
            raise self._error(error) from error

    def tell(self) -> int:
        """Return the number of bytes written."""
        return self._size

    def write(self, data: bytes) -> None:
        """Append bytes."""
        left = memoryview(data)
        if self._failure is not None:
            raise self._failure
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as error:
            self._file.close()
            self._failure = self._error(error)
            raise self._failure from error
        self._sha.update(data)
        self._size += len(data)

    def mark(self) -> None:
        """Mark the end of the fixed part of the file; what follows may be replaced later."""
        self._mark = self._sha.copy()

    def close(self) -> Written:
        """Wait for the disk and close the file."""
        try:
            about = os.fstat(self._file.fileno())
            if not stat.S_ISCHR(about.st_mode):  # /dev/null stores nothing
                os.fsync(self._file.fileno())
            self._file.close()
        except OSError as error:
            raise self._error(error) from error
        return Written(about.st_dev, about.st_ino, self._sha.hexdigest(), self._mark)

    def _error(self, error: OSError) -> InputError:
        return InputError(f"{self._path}: cannot be written: {error.strerror}")
