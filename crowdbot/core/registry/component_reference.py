"""Components that a plugin names as text: ``"package.module:NAME"`` and ``"package.folder.*"``."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

from crowdbot.dsl.spec.component import Component
from crowdbot.errors import PluginError, did_you_mean, nearest

#: Suffix of modules that build components; they are not searched.
BUILD = "_build"


def referenced(reference: str, category: str) -> tuple[Component[Any], ...]:
    """Import the components of a reference and return them.

    Args:
        reference: ``"package.module:NAME"`` for one; ``"package.folder.*"`` for all whose specs
            are defined in a module below a package, in the order of modules and definitions.
        category: category of the components that ``*`` selects.

    Raises:
        PluginError: the reference has another form, or names no component.
    """
    module, colon, name = reference.partition(":")
    if colon and name.isidentifier():
        return (_component(import_module(module), name, reference),)
    if not colon and reference.endswith(".*"):
        package = import_module(reference.removesuffix(".*"))
        found = tuple(c for m in _modules(package) for c in _defined(m) if c.category == category)
        if not found:
            raise PluginError(f"'{reference}': no module has a {category}")
        return found
    raise PluginError(
        f'\'{reference}\' is not a reference: write "package.module:NAME" or "package.folder.*"'
    )


def _component(module: ModuleType, name: str, reference: str) -> Component[Any]:
    found = getattr(module, name, None)
    if not isinstance(found, Component):
        known = [n for n, value in vars(module).items() if isinstance(value, Component)]
        near = did_you_mean(nearest(name, known)[:1])
        raise PluginError(f"'{reference}': {module.__name__} has no component '{name}'{near}")
    return found


def _modules(package: ModuleType) -> Iterator[ModuleType]:
    """Yield a package and all modules below it, except those with build functions."""
    yield package
    for info in sorted(
        pkgutil.iter_modules(getattr(package, "__path__", ())), key=lambda i: i.name
    ):
        if info.name.endswith(BUILD) or info.name == "__main__":
            continue
        module = import_module(f"{package.__name__}.{info.name}")
        yield from _modules(module) if info.ispkg else (module,)


def _defined(module: ModuleType) -> Iterator[Component[Any]]:
    """Yield the components of a module whose specs it defines, each once."""
    found = [value for value in vars(module).values() if isinstance(value, Component)]
    for component in {id(c): c for c in found}.values():
        if component.spec.__module__ == module.__name__:
            yield component
