"""Loads one plugin: its module at once, its components when their category is asked for."""

from __future__ import annotations

import re
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from importlib import metadata
from typing import Any

from crowdbot import hookspecs
from crowdbot.core.registry import hooks
from crowdbot.core.registry.component_checks import NAME, check_components
from crowdbot.core.registry.component_list import ComponentList, Components
from crowdbot.core.registry.component_reference import referenced
from crowdbot.core.registry.plugin import Plugin
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.plugin_errors import is_user_interrupt, telling_interrupts
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import CrowdbotError, PluginError
from crowdbot.old_names import shown_old_names


def load_plugin(plugin: Plugin, load: Callable[[], Any]) -> Plugin:
    """Import a plugin and collect its components.

    Args:
        plugin: the plugin before loading.
        load: function that imports its module.

    Returns:
        The plugin with its components or an error. Its output goes to stderr.
    """
    try:
        with _call(plugin), shown_old_names():
            check_name(plugin)
            module = load()
            file = plugin.file or str(getattr(module, "__file__", None) or "")
            plugin = replace(plugin, file=file, api=_api(module, plugin.distribution))
            return _ask(plugin, module)
    except CrowdbotError as error:
        if is_user_interrupt(error):
            raise
        return failed(plugin, error)


def failed(plugin: Plugin, error: CrowdbotError) -> Plugin:
    """Return the plugin with an error instead of components."""
    lines = "".join(traceback.format_exception(error.__cause__ or error))
    return replace(plugin, components=(), scenario_dirs=(), error=str(error), traceback=lines)


def check_name(plugin: Plugin) -> None:
    """Check that a plugin's name can stand before the kinds of its components.

    Raises:
        PluginError: it cannot.
    """
    if NAME.fullmatch(plugin.name) is None:
        fit = re.sub(r"[^a-z0-9_]+", "_", plugin.name.lower()).lstrip("_0123456789")
        advice = f"; '{fit}' would do" if fit else ""
        raise PluginError(
            f"'{plugin.name}' is not a name for a plugin: lower-case letters, digits and _ after "
            f"a first letter{advice}"
        )


def _call(plugin: Plugin) -> PluginCall:
    """Return the boundary to a plugin that is being loaded."""
    return PluginCall("", sources=lambda: {plugin.file} if plugin.file else set())


def _api(module: Any, distribution: str) -> int:
    """Return the version of the hooks; a module without one was written for the first version."""
    version = getattr(module, "CROWDBOT_API", 1)
    oldest, newest = hookspecs.OLDEST_API, hookspecs.API_VERSION
    if type(version) is not int:
        raise PluginError(
            f"{distribution}: CROWDBOT_API must be a whole number such as {newest}, not {version!r}"
        )
    if not oldest <= version <= newest:
        spoken = str(newest) if oldest == newest else f"{oldest} to {newest}"
        raise PluginError(
            f"{distribution} was written for plugin API {version}; "
            f"this crowdbot {metadata.version('crowdbot')} speaks {spoken}"
        )
    return version


def _ask(plugin: Plugin, module: Any) -> Plugin:
    """Call the hooks of one plugin; check the components that need no import."""
    manager = hooks.manager_of(module, plugin.name)
    listed = hooks.listed(manager)
    components = ComponentList({c: partial(_found, plugin, c, e) for c, e in listed.items()})
    dirs = hooks.scenario_dirs(manager)
    for category, entries in listed.items():
        if not any(isinstance(entry, str) for entry in entries):
            components.of(category)
            if error := components.errors.get(category):
                raise error
    return replace(plugin, components=components, scenario_dirs=dirs)


def _found(plugin: Plugin, category: str, entries: Sequence[Component[Any] | str]) -> Components:
    """Return the components of one category, checked; references are imported."""
    found: list[Component[Any]] = []
    with telling_interrupts(), _call(plugin), shown_old_names():
        for entry in entries:
            found += referenced(entry, category) if isinstance(entry, str) else (entry,)
        check_components(plugin, category, found)
    return tuple(found)
