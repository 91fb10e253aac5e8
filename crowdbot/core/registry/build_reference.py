"""The build function that a component names as text: its import, and its arguments."""

from __future__ import annotations

import importlib
import inspect
import warnings
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import PluginError
from crowdbot.old_names import shown_old_names

Given = TypeVar("Given")


def load_build(component: Component[Any], call: PluginCall | None = None) -> Callable[..., object]:
    """Import the build function of a component.

    Args:
        call: call boundary to the plugin; default: one that names only the component.

    Raises:
        PluginError: the reference does not resolve to a function.
    """
    call = call or PluginCall(f"{component.category} '{component.kind}'")
    module, _, name = component.build.partition(":")
    with call(f"build '{component.build}' cannot be imported"), shown_old_names():
        try:
            function = getattr(importlib.import_module(module), name)
        except (ImportError, AttributeError) as error:
            raise PluginError(f"build '{component.build}' not found: {error}") from error
        if not callable(function):
            call.fail(f"build '{component.build}' is not a function")
        return function  # type: ignore[no-any-return]


def accepted(
    component: Component[Any], build: Callable[..., object], given: Sequence[Given]
) -> Sequence[Given]:
    """Return the arguments that a build function takes after the spec.

    Until 1.0 a sensor's may lack the last one, its context, which came later.
    """
    if component.category != "sensor" or not given or _takes(build, 1 + len(given)):
        return given
    warnings.warn(
        f"sensor '{component.kind}': '{component.build}' takes no context; add a last parameter, "
        "context: SensorContext, which crowdbot 1.0 will always hand over",
        DeprecationWarning,
        stacklevel=2,
    )
    return given[:-1]


def _takes(build: Callable[..., object], count: int) -> bool:
    """Return True if a function takes this many positional arguments.

    A last parameter with a default is an option of the plugin's own unless it is named context.
    """
    try:
        parameters = list(inspect.signature(build).parameters.values())
    except (TypeError, ValueError):  # compiled functions say nothing
        return True
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return True
    places = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    if len(places) < count:
        return False
    last = places[count - 1]
    return last.default is last.empty or last.name == "context"
