"""Names and groups of the commands, found without importing them."""

from __future__ import annotations

import keyword
import pkgutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path

#: Folders of commands, in the order of the help.
GROUPS = ("start", "run", "look", "compare", "challenge", "data", "extend")
_COMMANDS = Path(__file__).parent.parent / "commands"


@cache
def command_groups() -> Mapping[str, str]:
    """Return name -> group of all commands: group by group, each sorted."""
    return {
        name.replace("_", "-").rstrip("-"): group
        for group in GROUPS
        for name in sorted(m.name for m in pkgutil.iter_modules([str(_COMMANDS / group)]))
        if not name.startswith("_")
    }


def command_names() -> list[str]:
    """Return the names of all commands, sorted."""
    return sorted(command_groups())


def module_name(command: str) -> str:
    """Return the name of a command's module and function; Python keywords get a ``_``."""
    return command.replace("-", "_") + "_" * keyword.iskeyword(command)
