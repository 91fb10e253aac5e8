"""Files of Python installations and libraries, which every planner may read."""

from __future__ import annotations

import site
import sys
from collections.abc import Iterator
from functools import cache
from importlib.machinery import all_suffixes
from pathlib import Path
from typing import NamedTuple

#: Endings of names: further folders to search, and the metadata that name plugins.
_WRITTEN_BY_PIP = (".pth", ".dist-info", ".egg-info")


class Readable(NamedTuple):
    """Paths that a planner may read.

    Attributes:
        files: files, and folders with all that is in them.
        folders: folders of which only the names may be listed.
    """

    files: tuple[str, ...]
    folders: tuple[str, ...]


@cache
def python_libraries(search_path: tuple[str, ...]) -> Readable:
    """Return this Python, its installed packages, and modules on a search path.

    In folders on the search path outside the installation, such as a checkout, only modules are
    readable: recordings may lie there, too.
    """
    roots = [Path(p) for p in {sys.prefix, sys.base_prefix, sys.exec_prefix}]
    sites = [Path(p) for p in (*site.getsitepackages(), site.getusersitepackages())]
    installed = [p.resolve() for p in (*_interpreter(roots), *sites)]
    files = {str(p) for p in installed}
    folders: set[str] = set()
    for place in (*search_path, *_editable()):
        entry = Path(place or ".").resolve()
        if any(entry.is_relative_to(p) for p in installed):
            continue
        if entry.is_dir():
            folders.add(str(entry))
            files |= {str(p) for p in _importable(entry)}
        elif entry.is_file():
            files.add(str(entry))
    return Readable(tuple(sorted(files)), tuple(sorted(folders)))


def environment_of(program: Path) -> Iterator[str]:
    """Yield the folders that belong to a program in the ``bin`` of a Python or conda environment.

    A virtual environment refers to the Python that it was made from.
    """
    seen: set[Path] = set()
    for place in (program.absolute(), program.resolve()):
        root = place.parent.parent
        if place.parent.name != "bin" or root in seen:
            continue
        seen.add(root)
        settings = root / "pyvenv.cfg"
        if settings.is_file() or (root / "conda-meta").is_dir():
            yield str(root)
        else:
            yield from map(str, _interpreter([root]))
        yield from _editable_of(root)


def _interpreter(roots: list[Path]) -> Iterator[Path]:
    """Yield the folders of Pythons; ``/usr`` and the like may hold other things, too."""
    for root in roots:
        if (root / "pyvenv.cfg").is_file() or (root / "conda-meta").is_dir():
            yield root
            continue
        yield from (root / name for name in ("bin", "lib", "lib64", "include", "share"))


def _importable(folder: Path) -> Iterator[Path]:
    """Yield modules and packages in a folder, and their metadata by pip."""
    suffixes = tuple(all_suffixes())
    try:
        found = sorted(folder.iterdir())
    except OSError:
        return
    for one in found:
        is_module = one.name.endswith(suffixes)
        if is_module or one.suffix in _WRITTEN_BY_PIP or (one / "__init__.py").is_file():
            yield one


def _editable() -> Iterator[str]:
    """Yield the folders of packages that setuptools installed as editable."""
    for name, module in list(sys.modules.items()):
        if name.startswith("__editable__"):
            mapping = getattr(module, "MAPPING", {})
            yield from (str(Path(p).parent) for p in mapping.values() if isinstance(p, str))


def _editable_of(root: Path) -> Iterator[str]:
    """Yield packages that an environment of another Python finds by its ``.pth`` files."""
    for file in root.glob("lib/python3*/site-packages/*.pth"):
        try:
            lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError:
            continue
        for line in lines:
            folder = Path(line.strip())
            if folder.is_absolute() and folder.is_dir():
                yield from map(str, _importable(folder))
