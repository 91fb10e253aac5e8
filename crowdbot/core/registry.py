"""The registry: which components are installed. A value, built by a function, never changed.

Discovery isolates failures: a plugin that cannot be imported, or speaks another API version, is
listed with its error and hides nobody else. Two plugins of one name, or two components of one
kind, are all disabled, and the error names them.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from importlib import metadata
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Union

import pluggy
from pydantic import BaseModel, Field, SerializeAsAny, create_model

from crowdbot import hookspecs
from crowdbot.core.component import Component
from crowdbot.dsl.base import CATEGORIES, ComponentSpec
from crowdbot.dsl.components import components
from crowdbot.dsl.proximity import ProximitySpec, noise_map
from crowdbot.dsl.scenario import Crowd, NamedPolicy, Robot, Scenario
from crowdbot.errors import PluginError, UnknownNameError

GROUP = "crowdbot"
_HOOKS = {
    "crowdbot_environments": "environment",
    "crowdbot_robots": "robot",
    "crowdbot_sensors": "sensor",
    "crowdbot_noise_generators": "noise",
    "crowdbot_planners": "planner",
    "crowdbot_crowd_policies": "crowd policy",
    "crowdbot_cost_functions": "cost function",
    "crowdbot_metrics": "metric",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Plugin:
    """One installed plugin, healthy or not."""

    name: str
    distribution: str
    pinned: bool = True
    components: tuple[Component[Any], ...] = ()
    scenario_dirs: tuple[Any, ...] = ()
    error: str = ""


@dataclass(frozen=True)
class Registry:
    """All plugins, and the healthy ones' components by category and kind."""

    plugins: tuple[Plugin, ...]
    _by_category: Mapping[str, Mapping[str, Component[Any]]] = field(repr=False)

    def components(self, category: str) -> Mapping[str, Component[Any]]:
        """Kind -> component, sorted by kind."""
        return self._by_category[category]

    def find(self, category: str, kind: str) -> Component[Any]:
        """The component of one kind.

        Raises:
            UnknownNameError: nothing of that kind is installed.
        """
        known = self._by_category[category]
        if kind not in known:
            raise UnknownNameError(category, kind, known)
        return known[kind]

    def owner(self, component: Component[Any]) -> Plugin:
        """The plugin that provides a component."""
        return next(p for p in self.plugins if any(c is component for c in p.components))

    def build(self, spec: ComponentSpec, *args: Any) -> Any:
        """Turn a spec into deeds through its component's build function.

        That of a proximity sensor also gets its noise generators, built, in the order of names.
        """
        if isinstance(spec, ProximitySpec):
            args = ([self.build(spec.noise[name]) for name in sorted(spec.noise)], *args)
        return self.find(spec.category, spec.kind).load_build()(spec, *args)

    @cached_property
    def scenario_model(self) -> type[Scenario]:
        """`Scenario`, narrowed to the installed components."""
        policy: Any = (self._union("crowd policy"), ...)
        costs = self._named(Crowd, "costs", self._union("cost function"))
        named: Any = create_model(
            "NamedPolicy",
            __base__=NamedPolicy,
            __doc__=NamedPolicy.__doc__,
            policy=policy,
            costs=costs,
        )
        crowd: Any = create_model(
            "Crowd",
            __base__=Crowd,
            __doc__=Crowd.__doc__,
            policy=policy,
            costs=costs,
            policies=self._named(Crowd, "policies", named),
        )
        robot: Any = create_model(
            "Robot",
            __base__=Robot,
            __doc__=Robot.__doc__,
            model=(self._union("robot"), ...),
            sensors=self._named(Robot, "sensors", self._union("sensor")),
        )
        return create_model(
            "Scenario",
            __base__=Scenario,
            __doc__=Scenario.__doc__,
            environment=(self._union("environment"), ...),
            crowd=(crowd | None, None),
            robots=self._named(Scenario, "robots", robot),
        )

    def spec_versions(self, scenario: Scenario) -> dict[str, int]:
        """Kind -> spec_version of every component a scenario uses."""
        used = [spec for _, spec in components(scenario)]
        return {s.kind: self.find(s.category, s.kind).spec_version for s in used}

    def spec_model(self, category: str, kind: str) -> type[ComponentSpec]:
        """The spec of one kind, narrowed to the installed components where it holds others."""
        spec: type[ComponentSpec] = self.find(category, kind).spec
        if not issubclass(spec, ProximitySpec):
            return spec
        noise: Any = noise_map(self._union("noise")), spec.model_fields["noise"]
        return create_model(spec.__name__, __base__=spec, noise=noise)

    @staticmethod
    def _named(base: type[BaseModel], field: str, member: Any) -> Any:
        """A map of named members, described as in the base model."""
        description = base.model_fields[field].description
        return dict[str, member], Field(default={}, description=description)

    def _union(self, category: str) -> Any:
        specs: Any = tuple(self.spec_model(category, kind) for kind in self._by_category[category])
        if not specs:
            broken = [f"{p.name} ({p.error})" for p in self.plugins if p.error]
            why = f"; plugins that failed: {', '.join(broken)}" if broken else ""
            raise PluginError(f"no {category} is installed{why}")
        if len(specs) == 1:  # a discriminator needs two members
            return SerializeAsAny[specs[0]]  # type: ignore[misc]
        return Annotated[Union[specs], Field(discriminator="kind")]  # noqa: UP007


def discover(
    *, extra: Sequence[Path] = (), allow: Iterable[str] | None = None, entry_points: bool = True
) -> Registry:
    """Build the registry from entry points and from folders or files given by hand.

    Args:
        extra: paths of plugins that are not installed (``--plugin DIR``).
        allow: only these plugin names; default: ``CROWDBOT_PLUGINS``, else all.
        entry_points: False reads no entry points except crowdbot's own.
    """
    if allow is None and os.environ.get("CROWDBOT_PLUGINS"):
        allow = os.environ["CROWDBOT_PLUGINS"].split(",")
    wanted = None if allow is None else {"builtin", *(a.strip() for a in allow)}
    found = [
        _load(e.name, _distribution(e), e.load)
        for e in sorted(metadata.entry_points(group=GROUP), key=lambda e: (e.name, e.value))
        if (entry_points or e.name == "builtin") and (wanted is None or e.name in wanted)
    ]
    found += [
        replace(_load(p.resolve().stem, str(p), partial(load_path, p)), pinned=False) for p in extra
    ]
    return assemble(found)


def assemble(found: Sequence[Plugin]) -> Registry:
    """Disable collisions and sort what is left into a registry."""
    plugins = _disable(found, _name_collisions(found))
    plugins = _disable(plugins, _kind_collisions(plugins))
    by_category: dict[str, dict[str, Component[Any]]] = {c.category: {} for c in CATEGORIES}
    for plugin in plugins:
        for component in plugin.components:
            by_category[component.category][component.kind] = component
    return Registry(tuple(plugins), {k: dict(sorted(v.items())) for k, v in by_category.items()})


def load_path(path: Path) -> ModuleType:
    """Import a Python file or a package folder under its own name, without installing it.

    Raises:
        PluginError: there is no such file, its name is taken, or it cannot be imported.
    """
    file = (path / "__init__.py" if path.is_dir() else path).resolve()
    name = path.resolve().stem
    if not file.is_file():
        raise PluginError(f"{path}: no Python file or package")
    taken = sys.modules.get(name)
    if taken is not None and getattr(taken, "__file__", None) == str(file):
        return taken
    if taken is not None or importlib.util.find_spec(name) is not None:
        raise PluginError(f"{path}: a module named '{name}' exists already; rename the plugin")
    return _import_file(name, file, package=path.is_dir())


def _import_file(name: str, file: Path, *, package: bool) -> ModuleType:
    folders = [str(file.parent)] if package else None
    spec = importlib.util.spec_from_file_location(name, file, submodule_search_locations=folders)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # build references name it
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _distribution(entry: metadata.EntryPoint) -> str:
    return f"{entry.dist.name} {entry.dist.version}" if entry.dist else entry.value


def _load(name: str, distribution: str, load: Any) -> Plugin:
    """One plugin in its own manager, so that an error stays its own."""
    try:
        module = load()
        _check_api(module, distribution)
        manager = pluggy.PluginManager("crowdbot")
        manager.add_hookspecs(hookspecs)
        manager.register(module, name)
        manager.check_pending()
        listed = [(h, c) for h in _HOOKS for cs in getattr(manager.hook, h)() for c in cs]
        for hook, component in listed:
            _check_component(name, hook, component)
        dirs = [d for ds in manager.hook.crowdbot_scenario_dirs() for d in ds]
    except Exception as error:
        text = f"{type(error).__name__}: {error}"
        return Plugin(name=name, distribution=distribution, error=text)
    return Plugin(
        name=name,
        distribution=distribution,
        components=tuple(c for _, c in listed),
        scenario_dirs=tuple(dirs),
    )


def _check_api(module: ModuleType, distribution: str) -> None:
    version = getattr(module, "CROWDBOT_API", hookspecs.API_VERSION)
    if version != hookspecs.API_VERSION:
        raise PluginError(
            f"{distribution} was written for plugin API {version}; "
            f"this crowdbot speaks {hookspecs.API_VERSION}"
        )


def _check_component(plugin: str, hook: str, component: Component[Any]) -> None:
    if component.category != _HOOKS[hook]:
        raise PluginError(f"{hook} returned {component.kind}, a {component.category}")
    if plugin != "builtin" and not component.kind.startswith(f"{plugin}."):
        raise PluginError(f"kind '{component.kind}' must start with '{plugin}.'")
    if component.category == "metric" and not component.has_card():
        place = component.card_place or "the component's 'card'"
        raise PluginError(f"metric '{component.kind}' has no card; it is looked for in {place}")


def _name_collisions(plugins: Sequence[Plugin]) -> dict[int, str]:
    twice = {n for n, k in Counter(p.name for p in plugins).items() if k > 1}
    return {
        i: f"E301 plugin name '{p.name}' is claimed by {_names(plugins, p.name)}"
        for i, p in enumerate(plugins)
        if p.name in twice
    }


def _names(plugins: Sequence[Plugin], name: str) -> str:
    return " and ".join(p.distribution for p in plugins if p.name == name)


def _kind_collisions(plugins: Sequence[Plugin]) -> dict[int, str]:
    owners: dict[tuple[str, str], list[int]] = {}
    for i, plugin in enumerate(plugins):
        for component in plugin.components:
            owners.setdefault((component.category, component.kind), []).append(i)
    errors = {}
    for (category, kind), indices in owners.items():
        if len(indices) > 1:
            who = " and ".join(plugins[i].distribution for i in indices)
            errors.update(dict.fromkeys(indices, f"E301 {category} '{kind}' is provided by {who}"))
    return errors


def _disable(plugins: Sequence[Plugin], errors: Mapping[int, str]) -> list[Plugin]:
    return [
        replace(p, components=(), scenario_dirs=(), error=errors[i]) if i in errors else p
        for i, p in enumerate(plugins)
    ]
