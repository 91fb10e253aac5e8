"""The SHA-256 of all files that a Python file consists of: modules beside it, and declared data."""

from __future__ import annotations

import ast
import hashlib
import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib.machinery import all_suffixes
from pathlib import Path

from crowdbot.errors import InputError

_FOREIGN = {*sys.stdlib_module_names, "crowdbot"}
#: Functions whose first argument, where it is text, is the name of a module.
_BY_NAME = ("import_module", "__import__")
_MOST_DATA = 10_000


def source_digest(file: Path, data: Sequence[str] = ()) -> str:
    """SHA-256 of a file; with modules beside it that it imports, or data, of these as well.

    Imports are read from the text, at any depth, so that the same files have the same digest
    whatever else was imported before.

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
    """SHA-256 of the names and contents of some files, in order of names.

    Raises:
        InputError: one cannot be read.
    """
    sha = hashlib.sha256()
    for name in sorted(files):
        sha.update(f"{name}\0{file_digest(files[name])}\n".encode())
    return sha.hexdigest()


def file_digest(file: Path) -> str:
    """SHA-256 of one file.

    Raises:
        InputError: it cannot be read.
    """
    try:
        with file.open("rb") as opened:
            return hashlib.file_digest(opened, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror}") from None


def data_files(folder: Path, patterns: Iterable[str]) -> dict[str, Path]:
    """Name -> file for all that some names or patterns stand for.

    Args:
        folder: what they are relative to.
        patterns: file names; ``*``, ``?``, ``[…]`` and ``**`` as in a glob; a folder means all
            files in it.

    Raises:
        InputError: one of them matches no file, or there are unreasonably many.
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
    """What a class says in ``data = ("weights.npz",)``; nothing where it says nothing of the kind.

    A field of a spec with this name is a parameter, and no declaration.
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
    """Name -> file of a package, and of modules beside it that it imports.

    What lies in ``__pycache__`` or begins with a dot is left out.
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


def imported_names(file: Path) -> set[str]:
    """First parts of the names of all modules that a file, or one beside it, imports."""
    return {name for one in _with_helpers(file) for name in _imported(one)}


def _with_helpers(file: Path) -> set[Path]:
    return {file} | _helpers_of(file.parent, [file], set())


def _helpers_of(folder: Path, files: Iterable[Path], own: set[str]) -> set[Path]:
    """Files of the modules in a folder that some files import, or that those import."""
    waiting, found = list(files), set[Path]()
    seen = set(waiting)
    while waiting:
        for name in _imported(waiting.pop()) - _FOREIGN - own:
            new = set(_beside(folder, name)) - seen
            found |= new
            seen |= new
            waiting += [f for f in new if f.suffix == ".py"]
    return found


def _imported(file: Path) -> set[str]:
    """First parts of the names of all modules that a file imports."""
    try:
        nodes = list(ast.walk(ast.parse(file.read_bytes())))
    except (SyntaxError, ValueError, RecursionError, OSError):
        return set()  # importing it says why
    names = {alias.name for n in nodes if isinstance(n, ast.Import) for alias in n.names}
    names |= {n.module for n in nodes if isinstance(n, ast.ImportFrom) and n.module and not n.level}
    names |= {name for n in nodes if isinstance(n, ast.Call) for name in _named(n)}
    return {name.partition(".")[0] for name in names}


def _named(call: ast.Call) -> Iterator[str]:
    """The module that a call imports by its name."""
    called = call.func
    name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
    if name in _BY_NAME and call.args and isinstance(call.args[0], ast.Constant):
        value = call.args[0].value
        if isinstance(value, str):
            yield value


def _beside(folder: Path, name: str) -> Iterator[Path]:
    """The files of a module or package in a folder, compiled ones too."""
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
    """Files that a pattern stands for; one that is absolute, or goes up, is a name."""
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
    """As seen from the folder, however it is called itself."""
    return Path(os.path.relpath(file.resolve(), folder.resolve())).as_posix()
