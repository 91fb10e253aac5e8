"""The folder in which numba keeps compiled functions, and the test if they are stale."""

from __future__ import annotations

import os
from pathlib import Path

_PACKAGE = Path(__file__).parents[2]
_VARIABLE = "NUMBA_CACHE_DIR"
_PLAIN = "CROWDBOT_PLAIN_NUMBA"
_LOCATORS = "NUMBA_CACHE_LOCATOR_CLASSES"
#: Numba's cache locators in order: its own follow if the first has no file or no folder.
_CLASSES = ",".join(
    ("crowdbot.core.support.compile_cache_locator.CompiledStateLocator",
     "UserWideCacheLocator", "IPythonCacheLocator", "ZipCacheLocator")
)  # fmt: skip


def is_plain_numba() -> bool:
    """Return True if numba's own ``njit`` is to compile, without `compile_parts`."""
    return os.environ.get(_PLAIN, "0") not in ("", "0")


def use_kernel_cache() -> None:
    """Set numba's cache folder, which it reads on import; a user's own setting is kept."""
    os.environ.setdefault(_VARIABLE, str(kernel_folder()))
    os.environ.setdefault(_LOCATORS, _CLASSES)


#: Approximate number of compiled functions after a first run with people, sensors and dwa.
USUAL = 218


def nothing_compiled() -> bool:
    """Return True if compiled functions are going to be written for the first time."""
    return next(_folder().rglob("*.nbi"), None) is None


def compiled() -> int:
    """Return how many functions have been compiled so far."""
    return sum(name.endswith(".nbi") for _, _, names in os.walk(_folder()) for name in names)


def _folder() -> Path:
    return Path(os.environ.get(_VARIABLE) or kernel_folder())


def kernel_folder(package: Path = _PACKAGE) -> Path:
    """Return a folder inside the package where that can be written, else in the user's cache."""
    name = "kernels-plain" if is_plain_numba() else "kernels"
    if os.access(package, os.W_OK):
        return package / "__pycache__" / name
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return cache / "crowdbot" / name
