"""Checks of a component before it is registered."""

from __future__ import annotations

import inspect
import re
from collections.abc import Sequence
from functools import lru_cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import Field, TypeAdapter

from crowdbot.core.registry.component_data import files_of_data
from crowdbot.core.registry.hooks import shown
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import CATEGORIES
from crowdbot.dsl.spec.metric_component import MetricComponent
from crowdbot.dsl.spec.parts import parts_category
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import PluginError

NAME = re.compile(r"[a-z][a-z0-9_]*")
#: Part of a kind after the plugin's name and a dot.
_AFTER_DOT = re.compile(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*")


class _Probe(ComponentSpec):
    """A second member for a union; it never occurs in documents."""

    kind: Literal["-"] = "-"


def check_components(plugin: Plugin, category: str, components: Sequence[Component[Any]]) -> None:
    """Check all components of one category of a plugin.

    Raises:
        PluginError: one breaks a rule; see docs/reference/plugins.md.
        InputError: one declares data that matches no file.
    """
    for component in components:
        _check_component(plugin, category, component)
    kinds = [component.kind for component in components]
    for kind in kinds:
        if kinds.count(kind) > 1:
            raise PluginError(f"E301 {category} '{kind}' is provided twice")
    if plugin.name != BUILTIN:  # whose models the tests build
        _check_models(components)
        for component in components:
            files_of_data(component)


def _check_component(plugin: Plugin, category: str, component: Component[Any]) -> None:
    kind = _literal_kind(component)
    if component.category != category:
        raise PluginError(f"{kind} is listed as a {category}, but it is a {component.category}")
    begin, rest = ("", NAME) if plugin.name == BUILTIN else (f"{plugin.name}.", _AFTER_DOT)
    if not kind.startswith(begin):
        raise PluginError(f"kind '{kind}' must start with '{begin}'")
    if rest.fullmatch(kind.removeprefix(begin)) is None:
        raise PluginError(f"kind '{kind}': letters, digits, _ and - only after the dot")
    _check_parts(component)
    if not isinstance(component.build, str) or component.build.count(":") != 1:
        raise PluginError(
            f'{kind}: build must be text, "package.module:function", not {component.build!r}'
        )
    if category == "metric" and not isinstance(component, MetricComponent):
        raise PluginError(f"metric '{kind}' is not a MetricComponent; use declare_metric")
    if category == "metric" and not component.has_card():
        place = component.card_place or "the component's 'card'"
        raise PluginError(f"metric '{kind}' has no card; it is looked for in {place}")


def _literal_kind(component: Component[Any]) -> str:
    """Return a component's kind, which its spec must declare as a single literal."""
    spec = component.spec
    if not (inspect.isclass(spec) and issubclass(spec, ComponentSpec)):
        raise PluginError(
            f"{shown(spec)} is not a spec: it must derive from one of those in crowdbot.plugin"
        )
    field = spec.model_fields.get("kind")
    values = get_args(field.annotation) if field else ()
    literal = field is not None and get_origin(field.annotation) is Literal
    if not literal or len(values) != 1 or not isinstance(values[0], str):
        raise PluginError(
            f"{spec.__name__}: kind must be one literal: "
            'kind: Literal["plugin.name"] = "plugin.name"'
        )
    return component.kind


def _check_parts(component: Component[Any]) -> None:
    """Refuse parts of a category that does not come after the component's, to exclude cycles."""
    order = [c.category for c in CATEGORIES]
    try:
        parts = parts_category(component.spec)
    except TypeError as error:
        raise PluginError(f"{component.kind}: {error}") from error
    if parts and order.index(parts) <= order.index(component.category):
        after = ", ".join(order[order.index(component.category) + 1 :]) or "none"
        raise PluginError(
            f"{component.kind}: a {component.category} cannot have parts of the category "
            f"'{parts}'; what it can have: {after}"
        )


def _check_models(components: Sequence[Component[Any]]) -> None:
    """Check that documents can be read with the specs, alone and beside others.

    The specs of all plugins go into one model; one that cannot be built would take it down. All
    of a category are tried at once, which is quick, and one after the other only if that fails.
    """
    try:
        _try_models(tuple(c.spec for c in components))
    except Exception:
        for component in components:
            _check_model(component)
        raise


def _check_model(component: Component[Any]) -> None:
    try:
        component.spec.model_rebuild(raise_errors=True)
        _try_models((component.spec,))
    except Exception as error:
        first = str(error).strip().partition("\n")[0]
        raise PluginError(
            f"{component.kind}: {component.spec.__name__} cannot be built: "
            f"{type(error).__name__}: {first}"
        ) from error


@lru_cache(maxsize=64)  # a process that looks again finds the same classes
def _try_models(specs: tuple[type[ComponentSpec], ...]) -> None:
    members: Any = (*specs, _Probe)
    adapter: TypeAdapter[Any] = TypeAdapter(
        Annotated[Union[members], Field(discriminator="kind")]  # noqa: UP007
    )
    if not adapter.pydantic_complete:
        raise TypeError("a field of the spec has a type that Python does not find")
