"""Tells numba when a plugin's compiled functions are out of date.

Numba compiles a function again when its own file has changed, but not when a function that it
calls, in another file, has. crowdbot's own functions lie in a folder that is named after the state
of all its sources (`crowdbot.core.support.compile_cache`). Those of plugins lie there too, so
that they follow crowdbot's; and what is kept of them is good for one state of their own package's
sources.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from numba.core.caching import UserProvidedCacheLocator

_OURS = Path(str(files("crowdbot")))


class PackageLocator(UserProvidedCacheLocator):
    """Numba's locator for ``NUMBA_CACHE_DIR``, with a stamp of a whole package's sources."""

    def get_source_stamp(self) -> Any:
        """What must be as it was for compiled code to be used again."""
        file = Path(self._py_file)
        own = super().get_source_stamp()  # type: ignore[no-untyped-call]
        return own if file.is_relative_to(_OURS) else (own, package_state(package_of(file)))


def package_of(file: Path) -> Path:
    """The folder of the outermost package that a module belongs to, or the module's own."""
    folder = file.parent
    while (folder.parent / "__init__.py").is_file():
        folder = folder.parent
    return folder


@cache
def package_state(folder: Path) -> str:
    """Hash of names, sizes and times of the sources in a package, or beside a lone module."""
    state = hashlib.sha256()
    for file in sorted(_sources(folder)):
        about = file.stat()
        state.update(f"{file.relative_to(folder)} {about.st_size} {about.st_mtime_ns}\n".encode())
    return state.hexdigest()


def _sources(folder: Path) -> Iterator[Path]:
    whole = (folder / "__init__.py").is_file()
    return folder.rglob("*.py") if whole else folder.glob("*.py")
