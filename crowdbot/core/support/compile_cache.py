"""Where numba keeps compiled functions: one folder for each state of the sources.

Numba compiles a function again when its own file has changed, but not when a function that it
calls, in another file, has: after an update it would go on with the old one and say nothing.
`crowdbot.core.support.compile_cache_locator` does the same for plugins.
"""

from __future__ import annotations

import hashlib
import os
from importlib.resources import files
from pathlib import Path

_PACKAGE = Path(str(files("crowdbot")))
_VARIABLE = "NUMBA_CACHE_DIR"
_LOCATORS = "NUMBA_CACHE_LOCATOR_CLASSES"
#: What numba asks, in turn: where the first has no file or no folder, numba's own.
_CLASSES = ",".join(
    ("crowdbot.core.support.compile_cache_locator.PackageLocator",
     "UserWideCacheLocator", "IPythonCacheLocator", "ZipCacheLocator")
)  # fmt: skip


def use_kernel_cache() -> None:
    """Name the folder to numba, which reads it when it is imported; a user's own choice wins."""
    os.environ.setdefault(_VARIABLE, str(kernel_folder()))
    os.environ.setdefault(_LOCATORS, _CLASSES)


#: So many compiled functions a first run with people, sensors and dwa leaves.
USUAL = 186


def nothing_compiled() -> bool:
    """Whether compiled functions are going to be written for the first time."""
    return next(_folder().rglob("*.nbi"), None) is None


def compiled() -> int:
    """How many functions have been compiled so far."""
    return sum(1 for _ in _folder().rglob("*.nbi"))


def _folder() -> Path:
    return Path(os.environ.get(_VARIABLE) or kernel_folder())


def kernel_folder(package: Path = _PACKAGE) -> Path:
    """The folder for the sources as they are now.

    Inside the package where that can be written, else in the user's cache.
    """
    state = hashlib.sha256()
    for file in sorted(package.rglob("*.py")):
        about = file.stat()
        state.update(f"{file.relative_to(package)} {about.st_size} {about.st_mtime_ns}\n".encode())
    name = f"kernels-{state.hexdigest()[:16]}"
    if os.access(package, os.W_OK):
        return package / "__pycache__" / name
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "crowdbot" / name
