"""Imports the function that a component names as text."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import PluginError


def load_build(component: Component[Any], call: PluginCall | None = None) -> Callable[..., object]:
    """Import the build function of a component.

    Args:
        call: the boundary to the plugin; by default one that names the component only.

    Raises:
        PluginError: the reference does not resolve, or names something that is not a function.
    """
    call = call or PluginCall(f"{component.category} '{component.kind}'")
    module, _, name = component.build.partition(":")
    with call(f"build '{component.build}' cannot be imported"):
        try:
            function = getattr(importlib.import_module(module), name)
        except (ImportError, AttributeError) as error:
            raise PluginError(f"build '{component.build}' not found: {error}") from error
        if not callable(function):
            call.fail(f"build '{component.build}' is not a function")
        return function  # type: ignore[no-any-return]
