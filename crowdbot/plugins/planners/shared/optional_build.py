"""Import optional libraries of planners, which extras of crowdbot install."""

from __future__ import annotations

import importlib
from typing import Any

from crowdbot.plugin import PluginError


def library(kind: str, module: str, extra: str) -> Any:
    """Import a module of an extra.

    Args:
        kind: the planner that needs it.
        module: to import.
        extra: of crowdbot that installs it.

    Raises:
        PluginError: it is not installed, or cannot be imported.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise PluginError(
            f"planner '{kind}' needs the library {module.partition('.')[0]}: "
            f"pip install 'crowdbot[{extra}]' ({error})"
        ) from error
