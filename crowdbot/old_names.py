"""Deprecated names for plugins: they work until crowdbot 1.0, with a warning."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from types import ModuleType
from typing import Any

from crowdbot.errors import printable
from crowdbot.shown_warnings import warnings_to

_LOG = logging.getLogger("crowdbot")
#: Lists of `collected_old_names` that are open, the innermost last.
_COLLECTED: list[list[str]] = []


class OldNameWarning(DeprecationWarning):
    """A deprecated name, which will be removed in crowdbot 1.0."""


def old_name(module: str, new: ModuleType, name: str) -> Any:
    """Return a name that has moved to another module, for a module's ``__getattr__``.

    Raises:
        AttributeError: the new module has no such name.
    """
    if name not in new.__all__:
        raise AttributeError(f"module '{module}' has no attribute '{name}'")
    text = f"{module} is an old name that ends with crowdbot 1.0: import from {new.__name__}"
    warnings.warn(text, OldNameWarning, stacklevel=3)
    return getattr(new, name)


@contextmanager
def collected_old_names() -> Iterator[list[str]]:
    """Collect warnings of deprecated names in a context, one line each; show other warnings."""
    lines: list[str] = []

    def keep(text: str, file: str, line: int) -> None:
        lines.append(f"{file}:{line}: {text}")

    with warnings_to(keep, OldNameWarning):
        if not _are_errors():
            warnings.filterwarnings("default", category=OldNameWarning)
        _COLLECTED.append(lines)
        try:
            yield lines
        finally:
            _COLLECTED.remove(lines)


@contextmanager
def shown_old_names() -> Iterator[None]:
    """Print warnings of deprecated names in a context, one line each."""
    lines: list[str] = []
    try:
        with collected_old_names() as lines:
            yield
    finally:
        say_old_names(lines)


def say_old_names(lines: Iterable[str]) -> None:
    """Log warning lines once per process; inside `collected_old_names`, add them to its list."""
    for line in lines:
        if _COLLECTED:
            _COLLECTED[-1].append(line)
        else:
            _say(line)


@cache
def _say(line: str) -> None:
    _LOG.warning("warning: %s", printable(line))


def _are_errors() -> bool:
    """Return True if these warnings are to be exceptions."""
    kinds = [kind for action, _, kind, *_ in warnings.filters if action == "error"]
    return any(issubclass(OldNameWarning, kind) for kind in kinds)
