"""The old name of `crowdbot.plugin`, which stays until 1.0."""

from __future__ import annotations

from typing import Any

from crowdbot.core.interfaces.numbered_columns import NUMBERED_COLUMNS, numbered_column


def __getattr__(name: str) -> Any:
    from crowdbot import plugin
    from crowdbot.core.recording import old_names

    if name in NUMBERED_COLUMNS:
        return numbered_column(name)
    if name in old_names.__all__:
        return getattr(old_names, name)
    if name not in plugin.__all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(plugin, name)
