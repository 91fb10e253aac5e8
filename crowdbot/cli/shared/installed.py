"""The installed registry for commands."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from crowdbot.core.registry.registry import Registry


def installed(
    plugin: Sequence[Path] | None, no_plugins: bool = False, *, strict: bool = True
) -> Registry:
    """Return the registry for a command.

    Args:
        no_plugins: ignore installed plugins.
        strict: raise for a given plugin that failed; otherwise list it as failed.

    Raises:
        InputError: a path does not exist.
        PluginError: a given plugin failed.
    """
    from crowdbot.core.support.gc_throttle import throttled_gc
    from crowdbot.core.support.stdout_guard import stdout_to_stderr
    from crowdbot.errors import InputError, PluginError

    paths = list(plugin or ())
    for path in paths:
        if not path.exists():
            raise InputError(f"--plugin {path}: no such file or folder")
    with throttled_gc(), stdout_to_stderr():
        from crowdbot.core.registry.registry import discover

        registry = discover(extra=paths, allow=() if no_plugins else None)
        given = [found for found in registry.plugins if strict and found.given]
        for found in given:
            found.import_components()
    log = logging.getLogger("crowdbot")
    for line in registry.unknown_allowed():
        log.warning(line)
    for found in given:
        if found.failure:
            log.debug(found.failure_traceback)
            raise PluginError(f"--plugin {found.distribution}: {found.failure}")
    return registry
