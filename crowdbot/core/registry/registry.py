"""The registry: an immutable value with the installed components.

Discovery isolates failures: a plugin that cannot be imported, or has another API version, is listed
with its error and does not affect others. Plugins with the same name, or components of the same
kind, are all disabled, and the error names them.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, partial
from pathlib import Path
from typing import Annotated, Any, TypeVar, Union, cast

from pydantic import BaseModel, Field, SerializeAsAny, create_model

from crowdbot.core.registry.build_reference import accepted, load_build
from crowdbot.core.registry.component_list import ComponentsByKind, of_category
from crowdbot.core.registry.entry_points import ALLOW, find_plugins
from crowdbot.core.registry.name_collisions import disabled, kind_collisions, name_collisions
from crowdbot.core.registry.narrowed_models import Models, models_of
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.plugin_boundary import Exceptions, PluginCall
from crowdbot.core.registry.registry_source import RegistrySource, Whereabouts
from crowdbot.core.support.gc_throttle import throttled_gc
from crowdbot.dsl.scenario.components import components
from crowdbot.dsl.scenario.crowd import Crowd, NamedPolicy
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import CATEGORIES, MetricSpec, PlannerSpec
from crowdbot.dsl.spec.parts import narrowed, parts_category
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import CrowdbotError, PluginError, UnknownNameError, did_you_mean, nearest

__all__ = ["Plugin", "Registry", "assemble", "discover"]


Built = TypeVar("Built")

_IN_SCENARIOS = tuple(c.category for c in CATEGORIES if c not in (PlannerSpec, MetricSpec))


@dataclass(frozen=True)
class Registry:
    """All plugins, and the components of working ones by category and kind.

    Attributes:
        plugins: all allowed plugins that were found; some may have failed.
        excluded: installed plugins that are not on the allow-list; they were not imported.
        allowed: the allow-list; None allows all.
        source: arguments with which another process discovers the same; None if built manually.
    """

    plugins: tuple[Plugin, ...]
    _by_category: Mapping[str, Mapping[str, Component[Any]]] = field(repr=False)
    excluded: tuple[Plugin, ...] = ()
    allowed: tuple[str, ...] | None = None
    source: RegistrySource | None = None

    def components(self, category: str) -> Mapping[str, Component[Any]]:
        """Return kind -> component, sorted by kind."""
        return self._by_category[category]

    def find(self, category: str, kind: str) -> Component[Any]:
        """Return the component of one kind.

        Raises:
            UnknownNameError: nothing of that kind is installed.
        """
        known = self._by_category[category]
        if kind not in known:
            raise UnknownNameError(category, kind, known, self.why_absent(kind))
        return known[kind]

    def why_absent(self, name: str) -> str:
        """Return why a plugin's components are missing; empty if unknown.

        Args:
            name: a plugin, or a kind or suite of a plugin; of crowdbot's own kinds without a dot.
        """
        plugin = name.replace(":", ".").partition(".")[0]
        for p in self.plugins:
            if p.name == plugin and p.failure and plugin != BUILTIN:
                return f"plugin '{plugin}' ({p.distribution}) failed: {p.failure}"
            if p.name == BUILTIN and p.failure and plugin == name:
                return f"some of crowdbot's own components cannot be loaded: {p.failure}"
        for p in self.excluded:
            if p.name == plugin:
                why = f"{ALLOW}={','.join(self.allowed)}" if self.allowed else "--no-plugins"
                return f"plugin '{plugin}' ({p.distribution}) is installed but not allowed: {why}"
        return ""

    def import_components(self) -> None:
        """Import all components that plugins name as text; errors are in `Plugin.failure`."""
        for plugin in self.plugins:
            plugin.import_components()

    def unknown_allowed(self) -> list[str]:
        """Return one line for each name on the allow-list without a plugin."""
        known = {p.name for p in (*self.plugins, *self.excluded)}
        return [
            f"{ALLOW}: no plugin '{name}' is installed{did_you_mean(nearest(name, known)[:1])}"
            for name in self.allowed or ()
            if name not in known
        ]

    def owner(self, component: Component[Any]) -> Plugin:
        """Return the plugin that provides a component."""
        category = component.category
        return next(
            p
            for p in self.plugins
            if any(c is component for c in of_category(p.components, category))
        )

    def plugin_call(
        self,
        spec: ComponentSpec,
        *,
        error: type[PluginError] = PluginError,
        passes: Exceptions = CrowdbotError,
    ) -> PluginCall:
        """Return the boundary for calls into the plugin of a spec's component.

        Args:
            error: class for the plugin's exceptions.
            passes: exceptions that pass unchanged.
        """
        component = self.find(spec.category, spec.kind)
        plugin = self.owner(component)
        return PluginCall(
            f"{spec.category} '{spec.kind}' ({plugin.distribution})",
            sources=partial(_sources, plugin, component),
            error=error,
            passes=passes,
        )

    def build(
        self,
        spec: ComponentSpec,
        check: Callable[[object], Built],
        *args: object,
        call: PluginCall | None = None,
    ) -> Built:
        """Build the object of a spec, and check it.

        For environments, robots and so on, call ``build_environment`` and similar functions, which
        include the check.

        Args:
            spec: the spec; its parts, if its class has a field of parts, are built first and passed
                in order of their names.
            check: function that returns the object if it satisfies its category's interface, else
                raises; its errors count as the plugin's.
            args: further arguments of the build function.
            call: call boundary to the plugin; default: a new one.

        Raises:
            PluginError: the build function cannot be imported or raised, or its result fails the
                check.
        """
        if spec.parts_field:
            parts = spec.parts()
            args = ([self.build(parts[name], _unchecked) for name in sorted(parts)], *args)
        call = call or self.plugin_call(spec)
        component = self.find(spec.category, spec.kind)
        build = load_build(component, call)
        given = accepted(component, build, args)
        with call("cannot be built"):
            built = build(spec, *given)
        with call("what was built"):
            return check(built)

    @cached_property
    def scenario_model(self) -> type[Scenario]:
        """Return `Scenario`, narrowed to the installed components; shared by equal registries."""
        if Scenario.__name__ not in self._models:
            self._models.keep(self._narrowed_scenario(), Scenario.__name__)
        return cast(type[Scenario], self._models[Scenario.__name__])

    def narrowed(self, name: str) -> type[BaseModel]:
        """Return a class that is narrowed to the installed components, by its name.

        It is ``Scenario`` or a part of it, or ``CATEGORY KIND`` of a spec that contains others.
        """
        if name not in self._models and " " in name:
            self.spec_model(*name.rsplit(" ", 1))
        elif name not in self._models:
            _ = self.scenario_model
        return self._models[name]

    @cached_property
    def _models(self) -> Models:
        """Return the narrowed classes, which equal registries share."""
        return models_of(
            tuple(
                (category, component.spec)
                for category in _IN_SCENARIOS
                for component in self._by_category[category].values()
            ),
            self.source,
            blank_of,
        )

    def _narrowed_scenario(self) -> type[Scenario]:
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
        for part in (named, crowd, robot):
            self._models.keep(part, part.__name__)
        return create_model(
            "Scenario",
            __base__=Scenario,
            __doc__=Scenario.__doc__,
            environment=(self._union("environment"), ...),
            crowd=(crowd | None, None),
            robots=self._named(Scenario, "robots", robot),
        )

    def spec_versions(self, scenario: Scenario) -> dict[str, int]:
        """Return kind -> spec_version of every component in a scenario."""
        used = [spec for _, spec in components(scenario)]
        return {s.kind: self.find(s.category, s.kind).spec_version for s in used}

    def spec_model(self, category: str, kind: str) -> type[ComponentSpec]:
        """Return the spec of one kind, narrowed to installed components if it contains others."""
        spec: type[ComponentSpec] = self.find(category, kind).spec
        if not spec.parts_field:
            return spec
        name = f"{category} {kind}"
        if category in _IN_SCENARIOS and name in self._models:
            return cast(type[ComponentSpec], self._models[name])
        field = spec.model_fields[spec.parts_field]
        fields: Any = {
            spec.parts_field: (narrowed(field, self._union(parts_category(spec))), field)
        }
        model = create_model(spec.__name__, __base__=spec, **fields)
        return self._models.keep(model, name) if category in _IN_SCENARIOS else model

    @staticmethod
    def _named(base: type[BaseModel], field: str, member: Any) -> Any:
        """Return a map of named members, described as in the base model."""
        description = base.model_fields[field].description
        return dict[str, member], Field(default={}, description=description)

    def _union(self, category: str) -> Any:
        specs: Any = tuple(self.spec_model(category, kind) for kind in self._by_category[category])
        if not specs:
            broken = [f"{p.name} ({p.failure})" for p in self.plugins if p.failure]
            why = f"; plugins that failed: {', '.join(broken)}" if broken else ""
            raise PluginError(f"no {category} is installed{why}")
        if len(specs) == 1:  # a discriminator needs two members
            return SerializeAsAny[specs[0]]  # type: ignore[misc]
        return Annotated[Union[specs], Field(discriminator="kind")]  # noqa: UP007


def _unchecked(part: object) -> object:
    """Return a part unchanged; its owner checks it."""
    return part


def _sources(plugin: Plugin, component: Component[Any]) -> frozenset[str]:
    """Return the known source files of a component."""
    modules = (component.build.partition(":")[0], component.spec.__module__)
    files = (getattr(sys.modules.get(module), "__file__", None) for module in modules)
    return frozenset(f for f in (plugin.file, *files) if f)


@throttled_gc()
def discover(
    *, extra: Sequence[Path] = (), allow: Iterable[str] | None = None, entry_points: bool = True
) -> Registry:
    """Build the registry from installed plugins and given paths.

    Args:
        extra: paths of plugins that are not installed (``--plugin DIR``).
        allow: only these plugin names; default: ``CROWDBOT_PLUGINS``, else all.
        entry_points: False reads no entry points except crowdbot's own.
    """
    names = None if allow is None else tuple(allow)
    found = find_plugins(extra=extra, allow=names, entry_points=entry_points)
    source = RegistrySource(tuple(Path(p).resolve() for p in extra), names, entry_points)
    registry = assemble(found.plugins)
    return replace(registry, excluded=found.excluded, allowed=found.allowed, source=source)


def assemble(found: Sequence[Plugin]) -> Registry:
    """Disable name clashes and build the registry from the rest."""
    plugins = disabled(found, name_collisions(found))
    plugins = disabled(plugins, kind_collisions(plugins))
    by_category = ComponentsByKind(
        [c.category for c in CATEGORIES], [p.components for p in plugins]
    )
    return Registry(tuple(plugins), by_category)


@cache
def registry_of(where: Whereabouts) -> Registry:
    """Return the registry that another process had, discovered once per process."""
    extra, allow, entry_points = where
    return discover(extra=[Path(p) for p in extra], allow=allow, entry_points=entry_points)


def blank_of(where: Whereabouts, name: str) -> BaseModel:
    """Return an empty object of a narrowed class, which unpickling fills in."""
    model = registry_of(where).narrowed(name)
    return model.__new__(model)
