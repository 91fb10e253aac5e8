"""Registries with one component added for checks, and its examples as specs."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any
from unittest import SkipTest

from crowdbot.core.registry.registry import Plugin, Registry, assemble, discover
from crowdbot.core.scenarios.plugin_folders import plugin_folders
from crowdbot.dsl.spec.assets import Asset
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import CrowdPolicySpec
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import PluginError

#: People of the kit's worlds, for policies that follow a record.
RECORDED = 12


@cache
def installed() -> Registry:
    """Return the installed registry, discovered once."""
    return discover()


def components_of(plugin: str) -> tuple[Component[Any], ...]:
    """Return all components of an installed plugin, for `parametrize_with_checks`.

    Raises:
        PluginError: it is not installed, or it failed.
    """
    known = [p for p in installed().plugins if p.name == plugin]
    if not known:
        raise PluginError(f"no plugin '{plugin}' is installed")
    components = tuple(c for p in known for c in p.components)
    for found in known:
        if found.failure:
            raise PluginError(f"plugin '{plugin}' ({found.distribution}) failed: {found.failure}")
    return components


def around(component: Component[Any], registry: Registry | None = None) -> Registry:
    """Return a registry with this component, replacing one of its kind.

    Args:
        registry: the other components; default: the installed ones.
    """
    known = registry or installed()
    if any(c is component for p in known.plugins for c in p.components):
        return known
    kind = (component.category, component.kind)
    others = [
        replace(p, components=tuple(c for c in p.components if (c.category, c.kind) != kind))
        for p in known.plugins
        if not p.error
    ]
    checked = Plugin(name="the one checked", distribution="checked", components=(component,))
    return assemble([*others, checked])


def specs_of(component: Component[Any], registry: Registry) -> list[ComponentSpec]:
    """Return the component's examples, validated; files named ``NAME:path`` are found."""
    model = registry.spec_model(component.category, component.kind)
    return [
        _with_files(
            _with_record(model.model_validate({"kind": component.kind, **example})), registry
        )
        for example in component.examples
    ]


def with_zone(registry: Registry, spec: ComponentSpec, at: tuple[float, float]) -> ComponentSpec:
    """Return an environment's spec with a small zone ``kit``, 0.3 m from a point towards -x."""
    words = spec.model_dump(mode="json")
    x, y = at
    words["zones"] = {**words["zones"], "kit": {"x": [x - 0.4, x - 0.3], "y": [y, y + 0.1]}}
    return registry.spec_model(spec.category, spec.kind).model_validate(words)


def each_built(component: Component[Any], registry: Registry | None) -> Iterator[Any]:
    """Yield the unchecked result of the build function for each of the component's examples."""
    known = around(component, registry)
    for spec in specs_of(component, known):
        yield built(known, spec)


def built(registry: Registry, spec: ComponentSpec, *args: Any) -> Any:
    """Return the unchecked result of the component's build function.

    Raises:
        SkipTest: an optional library is not installed.
    """
    try:
        return registry.build(spec, lambda found: found, *args)
    except PluginError as error:
        if _is_optional(error.__cause__, registry.find(spec.category, spec.kind)):
            raise SkipTest(str(error)) from error
        raise


def _is_optional(error: BaseException | None, component: Component[Any]) -> bool:
    """Return True if a dependency is missing that is neither the package's own nor crowdbot's."""
    own = {component.build.partition(":")[0].partition(".")[0], "crowdbot"}
    return isinstance(error, ImportError) and (error.name or "").partition(".")[0] not in own


def _with_record(spec: ComponentSpec) -> ComponentSpec:
    """Return the spec; if it needs recorded people, with a recording made by `_record`."""
    record = spec.record if isinstance(spec, CrowdPolicySpec) else None
    if record is None:
        return spec
    (name,) = (n for n in type(spec).model_fields if getattr(spec, n) == record)
    return spec.model_copy(update={name: type(record)(path=str(_record()))})


def _with_files(spec: ComponentSpec, registry: Registry) -> ComponentSpec:
    """Return the spec with the paths of files in plugins (``NAME:path``) made absolute."""
    named = {n: a.path for n, a in vars(spec).items() if isinstance(a, Asset) and ":" in a.path}
    if not named:
        return spec
    roots = plugin_folders(registry)
    found: dict[str, Asset] = {}
    for name, text in named.items():
        plugin, _, path = text.rpartition(":")
        places = [folder / path for folder in roots.get(plugin, ())]
        at = next((place for place in places if place.is_file()), None)
        if at is not None:
            found[name] = Asset(path=str(at))
    return spec.model_copy(update=found)


@cache
def _record() -> Path:
    """Return the path of a record of `RECORDED` people who walk straight for a minute."""
    folder = tempfile.TemporaryDirectory(prefix="crowdbot-kit-")
    _KEPT.append(folder)  # kept until the process ends
    rows = [f"{t},{i},{0.5 * i + t},{0.3 * i}" for i in range(RECORDED) for t in (0.0, 60.0)]
    path = Path(folder.name) / "people.csv"
    path.write_text("\n".join(["t,id,x,y", *rows, ""]), encoding="utf-8")
    return path


_KEPT: list[tempfile.TemporaryDirectory[str]] = []
