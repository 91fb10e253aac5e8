"""The list of plugins, as text or JSON."""

from __future__ import annotations

import os
import shutil
import sys
import textwrap
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from crowdbot.core.registry.plugin import Plugin
    from crowdbot.core.registry.registry import Registry
    from crowdbot.dsl.spec.component import Component

_HEAD = ["plugin", "distribution", "api", "state", "provides"]
_FEW = 6
#: Minimum width of the last column beside the others.
_LEAST = 24


def as_text(registry: Registry) -> str:
    """Return one row per plugin; disallowed ones come last."""
    from crowdbot.core.registry.entry_points import ALLOW

    rows = [_row(p) for p in registry.plugins]
    why = f"not on the list {ALLOW}" if registry.allowed else "--no-plugins"
    rows += [[p.name, p.distribution, "–", "off", why] for p in registry.excluded]
    text = table([_HEAD, *rows])
    if any(p.failure and p.failure_traceback for p in registry.plugins):
        text += "\n-v shows tracebacks"
    return text


def as_dicts(registry: Registry) -> list[dict[str, Any]]:
    """Return the table as JSON data, with all components."""
    found = [_as_dict(p, "failed" if p.failure else "ok") for p in registry.plugins]
    return found + [_as_dict(p, "off") for p in registry.excluded]


def tracebacks(registry: Registry) -> Iterator[str]:
    """Yield the errors of failed plugins."""
    for plugin in registry.plugins:
        if plugin.failure:
            text = plugin.failure_traceback or plugin.failure
            yield f"\n{plugin.name} ({plugin.origin}):\n{text}".rstrip()


def table(rows: Sequence[Sequence[str]]) -> str:
    """Return a table with columns as wide as needed; the last one fits the terminal."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]) - 1)]
    lines = []
    for row in rows:
        cells = [f"{cell:<{width}}" for cell, width in zip(row, widths, strict=False)]
        before = "  ".join([*cells, ""])
        lines += _wrapped(before, row[-1])
    return "\n".join(lines)


def _wrapped(before: str, last: str) -> list[str]:
    """Return a row whose last cell is wrapped if the terminal is too narrow."""
    seen = sys.stdout.isatty() or "COLUMNS" in os.environ  # other outputs need no wrapping
    room = shutil.get_terminal_size().columns - len(before) if seen else 0
    if not seen or len(last) <= room:
        return [f"{before}{last}".rstrip()]
    if room < _LEAST:
        indent, width = 4 * " ", max(_LEAST, room + len(before) - 4)
        below = textwrap.wrap(last, width, initial_indent=indent, subsequent_indent=indent)
        return [before.rstrip(), *below]
    first, *rest = textwrap.wrap(last, room)
    return [f"{before}{first}", *(f"{' ' * len(before)}{line}" for line in rest)]


def _row(plugin: Plugin) -> list[str]:
    api = "–" if plugin.api is None else str(plugin.api)
    head = [plugin.name, plugin.distribution, api]
    if plugin.failure:
        return [*head, "failed", " ".join(plugin.failure.split())]
    provides = [f"{c}: {_few(kinds)}" for c, kinds in _provided(plugin).items()]
    provides += ["suites"] * bool(plugin.scenario_dirs)
    return [*head, "ok", "  ".join(provides) or "nothing"]


def _few(kinds: list[str]) -> str:
    return " ".join(kinds) if len(kinds) <= _FEW else str(len(kinds))


def _provided(plugin: Plugin) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for component in plugin.components:
        found.setdefault(component.category, []).append(component.kind)
    return found


def _as_dict(plugin: Plugin, state: str) -> dict[str, Any]:
    return {
        "name": plugin.name,
        "distribution": plugin.distribution,
        "pinned": plugin.pinned,
        "file": plugin.file,
        "api": plugin.api,
        "state": state,
        "error": plugin.failure,
        "traceback": plugin.failure_traceback,
        "provides": _provided(plugin),
        "components": [_component(c) for c in plugin.components],
        "scenario_dirs": [str(folder) for folder in plugin.scenario_dirs],
    }


def _component(component: Component[Any]) -> dict[str, Any]:
    return {
        "kind": component.kind,
        "category": component.category,
        "summary": component.summary,
        "spec": f"{component.spec.__module__}:{component.spec.__qualname__}",
        "build": component.build,
        "spec_version": component.spec_version,
        "experimental": component.experimental,
    }
