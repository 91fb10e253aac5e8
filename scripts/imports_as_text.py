"""Imports that are written as text, which no import graph shows: `import_module`, lazy names."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from crowdbot.lazy import stub_names

PACKAGE = "crowdbot"
_IMPORTERS = ("import_module", "__import__", "resolve_name")
#: Modules whose names come from everywhere, for users and for authors of plugins.
LAZY_FACES = (PACKAGE, f"{PACKAGE}.plugin")

Import = tuple[str, str]


def imports_as_text(root: Path, modules: Sequence[str]) -> list[Import]:
    """Importer and imported module of all imports that modules write as text.

    Args:
        root: the folder that holds the package.
        modules: names of all modules; a text may also name one of their attributes.
    """
    known = set(modules)
    found = [(m, _module_of(text, known)) for m in modules for text in _read(root, m).texts]
    return sorted(pair for pair in set(found) if pair[1])


def faces_imported_within(root: Path, modules: Sequence[str]) -> list[Import]:
    """Modules that import from the ``__init__`` of a package they lie in, if it imports modules.

    Such a module and the package import each other, whatever it takes from there.
    """
    names = {m: _read(root, m).names for m in modules}
    faces = {m for m in modules if _is_package(root, m) and _imports_own(names[m])}
    return [
        (module, package)
        for module in sorted(modules)
        for package in sorted(names[module] & faces)
        if module.startswith(f"{package}.")
    ]


class _Imports(NamedTuple):
    """What a module imports: texts that name modules, and what stands after ``from``."""

    texts: tuple[str, ...]
    names: frozenset[str]


@cache
def _read(root: Path, module: str) -> _Imports:
    """Parse a module, once for all that is asked about it, unless it cannot have any of that."""
    file = _file(root, module)
    text, stub = file.read_text("utf-8"), tuple(_stub(file, module))
    if not _is_package(root, module) and not any(word in text for word in _words(module)):
        return _Imports(stub, frozenset())
    tree = ast.parse(text)
    return _Imports((*_texts(tree), *stub), _imported_names(tree))


def _words(module: str) -> Iterator[str]:
    """Yield texts of which a module has one if it imports by text or from a package around it."""
    yield from _IMPORTERS
    package = module.rpartition(".")[0]
    while package:
        yield f"from {package} import"
        package = package.rpartition(".")[0]


def _stub(file: Path, module: str) -> Iterator[str]:
    """Modules that a stub names beside a module; its names are imported on first use."""
    if module not in LAZY_FACES and file.with_suffix(".pyi").is_file():
        yield from (home.module for home in stub_names(str(file)).values())


def _texts(tree: ast.Module) -> Iterator[str]:
    """Names of modules in calls that import what a text names."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        called = node.func.attr if isinstance(node.func, ast.Attribute) else ""
        called = node.func.id if isinstance(node.func, ast.Name) else called
        if called in _IMPORTERS:
            yield _literal(node.args[0])


def _literal(node: ast.expr) -> str:
    """The text of an expression, of an f-string as far as it is fixed; empty of any other."""
    if isinstance(node, ast.JoinedStr) and node.values:
        return _literal(node.values[0]).rstrip(".")
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


def _module_of(text: str, known: set[str]) -> str:
    """The longest module that a text names; empty if it is none of ours."""
    name = text.partition(":")[0]
    while name and name not in known:
        name = name.rpartition(".")[0]
    return name


def _imports_own(names: frozenset[str]) -> bool:
    return any(name.startswith(f"{PACKAGE}.") for name in names)


def _imported_names(tree: ast.Module) -> frozenset[str]:
    """What stands after ``from`` in a module's imports, wherever they are."""
    found = (n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom))
    return frozenset(name for name in found if name)


def _is_package(root: Path, module: str) -> bool:
    return (root / module.replace(".", "/") / "__init__.py").is_file()


def _file(root: Path, module: str) -> Path:
    place = root / module.replace(".", "/")
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")
