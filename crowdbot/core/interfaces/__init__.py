"""The old name of `crowdbot.plugin`, which stays until 1.0."""

from __future__ import annotations

from typing import Any


def __getattr__(name: str) -> Any:
    from crowdbot import plugin

    if name not in plugin.__all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(plugin, name)
