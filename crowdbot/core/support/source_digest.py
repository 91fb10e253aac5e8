"""The SHA-256 of a Python file and of the modules beside it that it imports."""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Iterator
from pathlib import Path

_FOREIGN = {*sys.stdlib_module_names, "crowdbot"}


def source_digest(file: Path) -> str:
    """SHA-256 of a file; where it imports modules beside it, of these as well, in order of names.

    Imports are read from the text, at any depth, so that the same files have the same digest
    whatever else was imported before.
    """
    found = _with_helpers(file)
    if len(found) == 1:
        return hashlib.sha256(file.read_bytes()).hexdigest()
    sha = hashlib.sha256()
    for one in sorted(found):
        name = one.relative_to(file.parent).as_posix()
        sha.update(f"{name}\0{hashlib.sha256(one.read_bytes()).hexdigest()}\n".encode())
    return sha.hexdigest()


def imported_names(file: Path) -> set[str]:
    """First parts of the names of all modules that a file, or one beside it, imports."""
    return {name for one in _with_helpers(file) for name in _imported(one)}


def _with_helpers(file: Path) -> set[Path]:
    found, waiting = {file}, [file]
    while waiting:
        for name in _imported(waiting.pop()) - _FOREIGN:
            new = set(_beside(file.parent, name)) - found
            found |= new
            waiting += new
    return found


def _imported(file: Path) -> set[str]:
    """First parts of the names of all modules that a file imports."""
    try:
        nodes = list(ast.walk(ast.parse(file.read_bytes())))
    except (SyntaxError, ValueError):
        return set()  # importing it says why
    names = {alias.name for n in nodes if isinstance(n, ast.Import) for alias in n.names}
    names |= {n.module for n in nodes if isinstance(n, ast.ImportFrom) and n.module and not n.level}
    return {name.partition(".")[0] for name in names}


def _beside(folder: Path, name: str) -> Iterator[Path]:
    """The files of a module or package in a folder."""
    if (folder / name).is_dir():
        yield from (folder / name).rglob("*.py")
    elif (folder / f"{name}.py").is_file():
        yield folder / f"{name}.py"
