"""SHA-256 of all files that a Python file needs: modules beside it, and declared data."""

from __future__ import annotations

import ast
import hashlib
import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from importlib.machinery import all_suffixes
from pathlib import Path
from typing import Any, cast

from crowdbot.dsl.text.bounded_files import open_file, read_bytes, reason_of
from crowdbot.errors import InputError

_FOREIGN = {*sys.stdlib_module_names, "crowdbot"}
#: Functions whose first argument, if text, is a module name.
_BY_NAME = ("import_module", "__import__")
_MOST_DATA = 10_000
#: Size from which digests are remembered until a file changes, bytes.
_LARGE = 4 << 20
#: Largest file of a planner, such as weights, and largest source whose imports are read, bytes.
_LARGEST, _LARGEST_SOURCE = 32 * 10**9, 20_000_000


def source_digest(file: Path, data: Sequence[str] = ()) -> str:
    """Return the SHA-256 of a file; with modules beside it that it imports, or data, of all these.

    Imports are read from the source at any depth, so that equal files have equal digests regardless
    of earlier imports.

    Args:
        file: a Python file.
        data: names or patterns of files, relative to its folder.

    Raises:
        InputError: a name of the data matches no file, or a file cannot be read.
    """
    found = _with_helpers(file)
    named = {one.relative_to(file.parent).as_posix(): one for one in found}
    named |= data_files(file.parent, data)
    if len(named) == 1:
        return file_digest(file)
    return digest_of_files(named)


def digest_of_files(files: Mapping[str, Path]) -> str:
    """Return the SHA-256 of the names and contents of some files, in order of names.

    Raises:
        InputError: one cannot be read.
    """
    sha = hashlib.sha256()
    for name in sorted(files):
        sha.update(f"{name}\0{file_digest(files[name])}\n".encode())
    return sha.hexdigest()


def file_digest(file: Path) -> str:
    """Return the SHA-256 of one file.

    Raises:
        InputError: it cannot be read.
    """
    try:
        with open_file(file) as opened:
            about = os.fstat(opened.fileno())
            if about.st_size > _LARGEST:
                raise OSError(f"is larger than {_LARGEST // 10**9} GB")
            if about.st_size < _LARGE:
                return hashlib.file_digest(cast(Any, opened), "sha256").hexdigest()
            state = (about.st_dev, about.st_ino, about.st_size, about.st_ctime_ns)
            return _digest_of_state(file.absolute(), state)
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {reason_of(error)}") from None


@lru_cache(maxsize=1024)
def _digest_of_state(file: Path, state: tuple[int, ...]) -> str:
    """Return the digest of a large file; the time of its last change cannot be set."""
    del state
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()


def data_files(folder: Path, patterns: Iterable[str]) -> dict[str, Path]:
    """Return name -> file for all files that match names or patterns.

    Args:
        folder: folder of the names and patterns.
        patterns: file names; ``*``, ``?``, ``[…]`` and ``**`` as in a glob; a folder means all
            files in it.

    Raises:
        InputError: a pattern matches no file, or there are too many files.
    """
    found: dict[str, Path] = {}
    for pattern in patterns:
        files = sorted(_matching(folder, pattern))
        if not files:
            raise InputError(f"data '{pattern}' matches no file in {folder}")
        found |= {_name(file, folder): file for file in files}
        if len(found) > _MOST_DATA:
            raise InputError(f"data '{pattern}': more than {_MOST_DATA} files")
    return found


def declared_data(holder: object) -> tuple[str, ...]:
    """Return the declaration ``data = ("weights.npz",)`` of a class; empty without one.

    A spec field with this name is a parameter, not a declaration.
    """
    if "data" in getattr(holder, "model_fields", {}):
        return ()
    found = getattr(holder, "data", ())
    if isinstance(found, str):
        return (found,)
    if isinstance(found, (tuple, list)) and all(isinstance(x, str) for x in found):
        return tuple(found)
    return ()


def package_files(folder: Path) -> dict[str, Path]:
    """Return name -> file of a package, and of modules beside it that it imports.

    ``__pycache__`` and names that begin with a dot are left out.
    """
    own = {
        "/".join(file.relative_to(folder).parts): file
        for file in sorted(folder.rglob("*"))
        if file.is_file()
        and not any(p == "__pycache__" or p[0] == "." for p in file.relative_to(folder).parts)
    }
    sources = [f for f in own.values() if f.suffix == ".py"]
    beside = _helpers_of(folder.parent, sources, {folder.name}) - set(own.values())
    return own | {f"../{f.relative_to(folder.parent).as_posix()}": f for f in beside}


def source_files(file: Path) -> set[Path]:
    """Return a Python file and the modules beside it that it imports."""
    return _with_helpers(file)


def check_source(file: Path) -> None:
    """Raise an error for a Python file that is too large or too deeply nested to parse.

    Raises:
        InputError: it is larger than a source ever is.
    """
    if file.is_file() and file.stat().st_size > _LARGEST_SOURCE:
        raise InputError(f"{file}: is larger than {_LARGEST_SOURCE // 10**6} MB; sources are not")


def parsed_source(file: Path) -> ast.Module | None:
    """Return the syntax tree of a Python file; None if it has errors, which its import reports."""
    try:
        return ast.parse(read_bytes(file, _LARGEST_SOURCE))
    except (SyntaxError, ValueError, RecursionError, MemoryError, OSError):
        return None


def imported_names(file: Path) -> set[str]:
    """Return the top-level modules that a file, or one beside it, imports."""
    return {name for one in _with_helpers(file) for name in _imported(one)}


def _with_helpers(file: Path) -> set[Path]:
    return {file} | _helpers_of(file.parent, [file], set())


def _helpers_of(folder: Path, files: Iterable[Path], own: set[str]) -> set[Path]:
    """Return the files of modules in a folder that some files import, directly or indirectly."""
    waiting, helpers = list(files), set[Path]()
    seen = set(waiting)
    while waiting:
        for name in _imported(waiting.pop()) - _FOREIGN - own:
            new = set(_beside(folder, name)) - seen
            helpers |= new
            seen |= new
            waiting += [f for f in new if f.suffix == ".py"]
    return helpers


def _imported(file: Path) -> set[str]:
    """Return the top module names that a file imports."""
    tree = parsed_source(file)
    nodes = [] if tree is None else list(ast.walk(tree))
    names = {alias.name for n in nodes if isinstance(n, ast.Import) for alias in n.names}
    names |= {n.module for n in nodes if isinstance(n, ast.ImportFrom) and n.module and not n.level}
    names |= {name for n in nodes if isinstance(n, ast.Call) for name in _named(n)}
    return {name.partition(".")[0] for name in names}


def _named(call: ast.Call) -> Iterator[str]:
    """Yield the module that a call imports by name."""
    called = call.func
    name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
    if name in _BY_NAME and call.args and isinstance(call.args[0], ast.Constant):
        value = call.args[0].value
        if isinstance(value, str):
            yield value


def _beside(folder: Path, name: str) -> Iterator[Path]:
    """Yield the files of a module or package in a folder, including compiled ones."""
    if not name.isidentifier():
        return
    if (folder / name).is_dir():
        for file in (folder / name).rglob("*"):
            if file.is_file() and _is_module(file) and "__pycache__" not in file.parts:
                yield file
        return
    for file in folder.glob(f"{name}.*"):
        if file.is_file() and _is_module(file):
            yield file


def _is_module(file: Path) -> bool:
    return any(file.name.endswith(suffix) for suffix in all_suffixes())


def _matching(folder: Path, pattern: str) -> Iterator[Path]:
    """Yield files that match a pattern; absolute patterns, or ones that go up, are plain names."""
    place = Path(pattern).expanduser()
    if place.is_absolute() or ".." in place.parts:
        plain = place if place.is_absolute() else folder / place
        root, glob = plain.parent, plain.name
        while any(c in str(root) for c in "*?[") and root != root.parent:
            root, glob = root.parent, f"{root.name}/{glob}"
    else:
        root, glob = folder, pattern
    for found in root.glob(glob) if glob.strip("/") else ():
        if found.is_dir():
            yield from (f for f in found.rglob("*") if f.is_file())
        elif found.is_file():
            yield found


def _name(file: Path, folder: Path) -> str:
    """Return the name relative to the folder, regardless of the folder's name."""
    return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
