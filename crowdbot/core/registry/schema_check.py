"""Check that the specs of plugins can be described in a JSON Schema."""

from __future__ import annotations

from dataclasses import replace

from crowdbot.core.registry.loader import failed
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.registry import Registry, assemble
from crowdbot.errors import PluginError


def describable(registry: Registry) -> Registry:
    """Return the registry without plugins whose schemas fail; these are listed as failed.

    pydantic lets a spec generate its own schema, in code that nothing else calls. All schemas form
    one document, which a failing one would break.
    """
    plugins = [p if p.name == BUILTIN or p.error else _tried(p) for p in registry.plugins]
    if all(new is old for new, old in zip(plugins, registry.plugins, strict=True)):
        return registry
    rest = assemble(plugins)
    return replace(
        rest, excluded=registry.excluded, allowed=registry.allowed, source=registry.source
    )


def _tried(plugin: Plugin) -> Plugin:
    call = PluginCall("", sources=lambda: {plugin.file} if plugin.file else set())
    try:
        for component in plugin.components:
            with call(f"{component.kind}: its JSON Schema cannot be made"):
                component.spec.model_json_schema()
                component.spec.model_json_schema(mode="serialization")
    except PluginError as error:
        return failed(plugin, error)
    return plugin
