"""Names of the commands, found without importing them."""

from __future__ import annotations

import pkgutil
from pathlib import Path


def command_names() -> list[str]:
    """Return the names of all commands, sorted."""
    modules = (
        m.name for m in pkgutil.iter_modules([str(Path(__file__).parent.parent / "commands")])
    )
    return sorted(m.replace("_", "-") for m in modules if not m.startswith("_"))
