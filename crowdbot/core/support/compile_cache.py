"""The folder for numba's compiled functions, and the check if they are up to date."""

from __future__ import annotations

import logging
import os
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path

from crowdbot.errors import InputError

_LOG = logging.getLogger("crowdbot")
_PACKAGE = Path(__file__).parents[2]
_VARIABLE = "NUMBA_CACHE_DIR"
#: In a planner's process, the folder in which the simulator keeps compiled functions.
SIMULATORS = "CROWDBOT_KERNELS"
_PLAIN = "CROWDBOT_PLAIN_NUMBA"
_LOCATORS = "NUMBA_CACHE_LOCATOR_CLASSES"
#: Numba's cache locators in order: its own follow if the first has no file or no folder.
_CLASSES = ",".join(
    ("crowdbot.core.support.compiling.compile_cache_locator.CompiledStateLocator",
     "UserWideCacheLocator", "IPythonCacheLocator", "ZipCacheLocator")
)  # fmt: skip


def is_plain_numba() -> bool:
    """Return True if numba's own ``njit`` is to compile, without `compile_parts`."""
    return os.environ.get(_PLAIN, "0") not in ("", "0")


def use_kernel_cache() -> None:
    """Set numba's cache folder, which it reads on import; a user's own setting is kept.

    Where neither it nor the usual folders can be written, a temporary one is taken, with a note.
    """
    named = os.environ.get(_VARIABLE)
    if named and not os.environ.get(SIMULATORS) and not _can_be_written(Path(named)):
        _LOG.warning("NUMBA_CACHE_DIR: %s cannot be written", named)
        named = None
    os.environ[_VARIABLE] = named or str(kernel_folder())
    os.environ.setdefault(_LOCATORS, _CLASSES)


#: Approximate number of compiled functions after a first run with people, sensors and dwa.
USUAL = 283


def nothing_compiled() -> bool:
    """Return True if no compiled functions are stored yet."""
    return next(used_folder().rglob("*.nbi"), None) is None


def compiled() -> int:
    """Return the number of functions compiled so far by this process."""
    return sum(name.endswith(".nbi") for _, _, names in os.walk(used_folder()) for name in names)


def used_folder() -> Path:
    """Return the folder in which this process keeps compiled functions."""
    return Path(os.environ.get(_VARIABLE) or kernel_folder())


def kernel_folder(package: Path = _PACKAGE) -> Path:
    """Return a folder inside the package where that can be written, else in the user's cache.

    Raises:
        InputError: neither can be written.
    """
    name = "kernels-plain" if is_plain_numba() else "kernels"
    if os.access(package, os.W_OK):
        return package / "__pycache__" / name
    return _user_cache() / name


def lock_file() -> Path:
    """Return the file with the locks of processes that compile functions.

    It lies elsewhere: a planner's process may read the compiled functions, and could keep the lock.
    """
    return _user_cache() / "compiling.lock"


def is_readable_only(py_file: str) -> bool:
    """Return True for crowdbot's own functions in a planner's process, which may not write them."""
    return bool(os.environ.get(SIMULATORS)) and Path(py_file).is_relative_to(_PACKAGE)


@cache
def _user_cache() -> Path:
    """Return the user's cache, or a temporary folder of the user's own, with a note.

    Raises:
        InputError: neither can be written.
    """
    caches = [Path(path) for path in (os.environ.get("XDG_CACHE_HOME"),) if path]
    with suppress(RuntimeError):  # a user without a home
        caches = caches or [Path.home() / ".cache"]
    for folder in caches:
        if _can_be_written(folder / "crowdbot"):
            return folder / "crowdbot"
    temporary = Path(tempfile.gettempdir()) / f"crowdbot-{os.getuid()}"
    if not (_can_be_written(temporary) and temporary.lstat().st_uid == os.getuid()):
        raise InputError(
            "compiled functions can be kept nowhere: the user's cache and "
            f"{tempfile.gettempdir()} cannot be written; XDG_CACHE_HOME=FOLDER names a place"
        )
    _LOG.warning(
        "compiled functions are kept in %s, since there is no home that can be written; "
        "NUMBA_CACHE_DIR=FOLDER names another place",
        temporary,
    )
    return temporary


def _can_be_written(folder: Path) -> bool:
    """Return True if a folder is there, or can be made, for this user alone to write."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
