"""Folders of suites in plugins; those in archives are unpacked."""

from __future__ import annotations

import atexit
import logging
import os
import shutil
from collections.abc import Iterator
from functools import cache
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry
from crowdbot.errors import CrowdbotError, InputError

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

_LOG = logging.getLogger("crowdbot")
#: Largest number of files in one plugin's folder, including subfolders.
_MOST_FILES = 2000
_UNPACKED = "crowdbot-unpacked-"


def plugin_folders(registry: Registry) -> dict[str, list[Path]]:
    """Return plugin name -> its scenario folders; those in archives are unpacked.

    Unreadable folders are left out with a warning; other plugins' suites remain.
    """
    roots: dict[str, list[Path]] = {}
    for plugin in registry.plugins:
        call = PluginCall(f"suites of {plugin.distribution or plugin.name}")
        try:
            with call("cannot be read"):
                folders = [_real(f) for f in plugin.scenario_dirs if f.is_dir()]
        except CrowdbotError as error:
            _warn_once(f"{error}; they are left out")
            continue
        if folders:  # without folders, a plugin with a duplicate name would hide the other
            roots[plugin.name] = folders
    return roots


@cache
def _warn_once(text: str) -> None:
    _LOG.warning("%s", text)


def _real(folder: Any) -> Path:
    return Path(os.fspath(folder)) if isinstance(folder, Path) else _unpacked(folder)


@cache
def _unpacked(folder: Traversable) -> Path:
    """Return a folder of an archive as a real one, kept until the process ends."""
    import tempfile

    target = Path(tempfile.mkdtemp(prefix=_UNPACKED))
    atexit.register(shutil.rmtree, target, ignore_errors=True)
    _unpack(folder, target, count(1))
    return target


def _unpack(folder: Traversable, target: Path, numbers: Iterator[int]) -> None:
    """Copy a folder.

    Raises:
        InputError: it has too many files, or an invalid file name.
    """
    for item in folder.iterdir():
        if next(numbers) > _MOST_FILES:
            raise InputError(f"there are more than {_MOST_FILES} files")
        name = item.name
        if not isinstance(name, str) or name in ("", "..") or Path(name).name != name:
            raise InputError(f"{name!r:.80} is not the name of a file")
        if item.is_dir():
            (target / name).mkdir()
            _unpack(item, target / name, numbers)
        else:
            (target / name).write_bytes(item.read_bytes())
