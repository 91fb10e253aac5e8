"""Names and kinds that several plugins claim."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from crowdbot.core.registry.component_list import known_components
from crowdbot.core.registry.plugin import Plugin


def name_collisions(plugins: Sequence[Plugin]) -> dict[int, str]:
    """Return errors for duplicate names; crowdbot's own name is refused earlier."""
    names = Counter(p.name for p in plugins if not p.error)
    return {
        i: f"E301 plugin name '{p.name}' is claimed by {_origins(plugins, p.name)}"
        for i, p in enumerate(plugins)
        if names[p.name] > 1 and not p.error
    }


def _origins(plugins: Sequence[Plugin], name: str) -> str:
    return " and ".join(p.origin for p in plugins if p.name == name and not p.error)


def kind_collisions(plugins: Sequence[Plugin]) -> dict[int, str]:
    """Return an error for each plugin whose component has the kind of another one's."""
    owners: dict[tuple[str, str], list[int]] = {}
    for i, plugin in enumerate(plugins):
        for component in known_components(plugin.components):
            owners.setdefault((component.category, component.kind), []).append(i)
    errors = {}
    for (category, kind), indices in owners.items():
        if len(indices) > 1:
            origins = " and ".join(plugins[i].origin for i in indices)
            errors.update(
                dict.fromkeys(indices, f"E301 {category} '{kind}' is provided by {origins}")
            )
    return errors


def disabled(plugins: Sequence[Plugin], errors: Mapping[int, str]) -> list[Plugin]:
    """Return the plugins, those with an error (index -> text) without their components."""
    return [
        replace(p, components=(), scenario_dirs=(), error=errors[i]) if i in errors else p
        for i, p in enumerate(plugins)
    ]
