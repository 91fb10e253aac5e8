"""crowdbot's own components by category."""

from __future__ import annotations

from functools import cache
from typing import Any

from crowdbot.core.registry.registry import Registry, discover
from crowdbot.plugin import Component, MetricComponent


@cache
def built_in_registry() -> Registry:
    """Return a registry without plugins of others."""
    return discover(allow=(), entry_points=False)


def built_in(category: str) -> tuple[Component[Any], ...]:
    """Return the components of one category, sorted by kind."""
    return tuple(built_in_registry().components(category).values())


def built_in_metrics() -> tuple[MetricComponent[Any], ...]:
    """Return the metrics, sorted by kind."""
    return tuple(c for c in built_in("metric") if isinstance(c, MetricComponent))
