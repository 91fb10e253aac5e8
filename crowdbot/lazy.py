"""Import a package's names on first use, from the modules that its stub file names."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

_IMPORT = re.compile(r"^from (\S+) import (?:\(\s*)?(\w+) as (\w+)", re.MULTILINE)


class Home(NamedTuple):
    """The source of a name: a module, and the name there, which may be a submodule."""

    module: str
    name: str


def stub_names(file: str) -> Mapping[str, Home]:
    """Return the names that the stub beside a module imports as ``from m import a as b``.

    Args:
        file: the module's ``__file__``.
    """
    text = Path(file).with_suffix(".pyi").read_text(encoding="utf-8")
    return {name: Home(module, original) for module, original, name in _IMPORT.findall(text)}


def lazy_face(
    package: str, file: str, *own: str
) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """Return a module's ``__all__``, ``__getattr__`` and ``__dir__`` for the names of its stub.

    Args:
        package, file: the module's ``__name__`` and ``__file__``.
        own: public names that the module itself defines.
    """
    names = stub_names(file)
    public = sorted([*names, *own])
    return public, lazy_names(package, names), lambda: public


def lazy_names(package: str, names: Mapping[str, Home]) -> Callable[[str], Any]:
    """Return a module's ``__getattr__`` that imports these names on first use."""

    def get(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module, original = names[name]
        home = importlib.import_module(module)
        if hasattr(home, original):
            return getattr(home, original)
        return importlib.import_module(f"{module}.{original}")

    return get
