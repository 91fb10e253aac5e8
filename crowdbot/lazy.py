"""Modules whose names are imported on first use."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from typing import Any


def lazy_names(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """Return the ``__getattr__`` of a module.

    Args:
        package: its name, for messages.
        homes: module -> names that come from it, with spaces between them; ``Original=Name`` if the
            module uses another name. A name may also be a submodule.
    """
    found = {
        name or original: (module, original)
        for module, names in homes.items()
        for original, _, name in (text.partition("=") for text in names.split())
    }

    def get(name: str) -> Any:
        if name not in found:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module, original = found[name]
        home = importlib.import_module(module)
        if hasattr(home, original):
            return getattr(home, original)
        return importlib.import_module(f"{module}.{original}")

    return get
