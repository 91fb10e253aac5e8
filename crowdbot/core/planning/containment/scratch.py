"""The folder of a planner's process: its home, its temporary files and its compiled functions.

Uses only the standard library.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
import sys
import tempfile
from pathlib import Path

_PREFIX = "crowdbot-planner-"
_COMPILED = "compiled"
#: Depth at which a folder is moved up before it is deleted: deleting goes down by recursion.
_DEEPEST = 8


def make_folder(within: str = "") -> str:
    """Create an empty folder that only this user may enter, in the temporary folder by default.

    Returns:
        Its path; empty if the temporary folder cannot be written.

    Raises:
        OSError: it cannot be created in ``within``.
    """
    try:
        return tempfile.mkdtemp(prefix=_PREFIX, dir=within or None)
    except OSError:
        if within:
            raise
        return ""


def use_scratch(folder: str) -> None:
    """Let this process and its children keep temporary files in its folder only."""
    compiled = str(Path(folder, _COMPILED))
    os.environ.update(
        HOME=folder, TMPDIR=folder, TMP=folder, TEMP=folder, XDG_CACHE_HOME=folder,
        XDG_CONFIG_HOME=folder, XDG_DATA_HOME=folder, XDG_RUNTIME_DIR=folder,
        NUMBA_CACHE_DIR=compiled, PYTHONDONTWRITEBYTECODE="1",
        CROWDBOT_KERNELS=os.environ.get("NUMBA_CACHE_DIR", ""),
    )  # fmt: skip
    tempfile.tempdir = None
    sys.dont_write_bytecode = True
    if numba := sys.modules.get("numba"):
        numba.config.CACHE_DIR = compiled


def remove_scratch(folder: str) -> None:
    """Delete a planner's folder, whatever it left there; its processes have ended."""
    if not folder:
        return
    with contextlib.suppress(OSError):
        _flatten(Path(folder))
    with contextlib.suppress(RecursionError):
        shutil.rmtree(folder, ignore_errors=True)


def _flatten(folder: Path) -> None:
    """Move folders that lie deep up to the top, since deleting goes down by recursion.

    A planner may have made them without the right to list or change them.
    """
    waiting = [(folder, 0)]
    while waiting:
        place, depth = waiting.pop()
        place.chmod(0o700)
        for one in list(os.scandir(place)):
            if not one.is_dir(follow_symlinks=False):
                continue
            inside = Path(one.path)
            if depth >= _DEEPEST:
                inside = inside.rename(folder / secrets.token_hex())
                waiting.append((inside, 1))
            else:
                waiting.append((inside, depth + 1))
