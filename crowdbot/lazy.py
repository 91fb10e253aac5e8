"""Packages whose names are imported when they are first used."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from typing import Any


def lazy_names(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package.

    Args:
        package: its name, for messages.
        homes: module -> names that come from it, with spaces between them; ``Original=Name`` where
            the package calls it otherwise.
    """
    found: dict[str, tuple[str, str]] = {}
    for module, names in homes.items():
        for text in names.split():
            original, _, name = text.partition("=")
            found[name or original] = (module, original)

    def get(name: str) -> Any:
        if name not in found:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module, original = found[name]
        return getattr(importlib.import_module(module), original)

    return get
