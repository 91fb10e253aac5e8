"""Loads one plugin in a manager of its own, so that an error stays its own."""

from __future__ import annotations

import inspect
import re
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from importlib import metadata
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import pluggy
from pydantic import Field, TypeAdapter

import crowdbot.hookspecs as hookspecs
from crowdbot.core.registry.component_list import ComponentList, Components
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.plugin_boundary import PluginCall
from crowdbot.core.registry.plugin_errors import is_user_interrupt
from crowdbot.core.support.source_digest import data_files, declared_data, digest_of_files
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import CATEGORIES
from crowdbot.dsl.spec.metric_component import MetricComponent
from crowdbot.dsl.spec.parts import parts_category
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import CrowdbotError, PluginError, did_you_mean, nearest

HOOKS = {
    "crowdbot_environments": "environment",
    "crowdbot_robots": "robot",
    "crowdbot_sensors": "sensor",
    "crowdbot_noise_generators": "noise",
    "crowdbot_planners": "planner",
    "crowdbot_crowd_policies": "crowd policy",
    "crowdbot_cost_functions": "cost function",
    "crowdbot_metrics": "metric",
}
#: Categories of crowdbot's own components that no scenario holds: imported when asked for.
_LATER = ("planner", "metric")
_DIRS = "crowdbot_scenario_dirs"
_NAME = re.compile(r"[a-z][a-z0-9_]*")
#: What follows the plugin's name and a dot in a kind.
_AFTER_DOT = re.compile(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*")


class _Probe(ComponentSpec):
    """A second member for a union; no document means it."""

    kind: Literal["-"] = "-"


def load_plugin(plugin: Plugin, load: Callable[[], Any]) -> Plugin:
    """Import a plugin and ask it what it has.

    Args:
        plugin: what is known of it before.
        load: imports its module.

    Returns:
        The plugin with its components, or with the error that it has instead. What it prints
        meanwhile goes to stderr.
    """
    sources = {plugin.file} if plugin.file else set()
    try:
        with PluginCall("", sources=lambda: sources):
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
    """The plugin with an error instead of components."""
    lines = "".join(traceback.format_exception(error.__cause__ or error))
    return replace(plugin, components=(), scenario_dirs=(), error=str(error), traceback=lines)


def check_name(plugin: Plugin) -> None:
    """Whether a plugin's name can stand before the kinds of its components.

    Raises:
        PluginError: it cannot.
    """
    if _NAME.fullmatch(plugin.name) is None:
        fit = re.sub(r"[^a-z0-9_]+", "_", plugin.name.lower()).lstrip("_0123456789")
        advice = f"; '{fit}' would do" if fit else ""
        raise PluginError(
            f"'{plugin.name}' is not a name for a plugin: lower-case letters, digits and _ after "
            f"a first letter{advice}"
        )


def _api(module: Any, distribution: str) -> int:
    """The version of the hooks; a module that does not say was written for the first one."""
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
    """Call each hook of one plugin."""
    manager = pluggy.PluginManager("crowdbot")
    manager.add_hookspecs(hookspecs)
    manager.register(module, plugin.name)
    _check_hooks(manager, module)
    later = _LATER if plugin.name == BUILTIN else ()
    ask = {c: partial(_components, manager, plugin, hook, c) for hook, c in HOOKS.items()}
    known = {category: of() for category, of in ask.items() if category not in later}
    listed = ComponentList(known, {category: ask[category] for category in later})
    components = listed.known
    _check_twice(components)
    if plugin.name != BUILTIN:  # whose models the tests build
        for category in dict.fromkeys(c.category for c in components):
            _check_models([c for c in components if c.category == category])
    dirs = tuple(_returned(manager, _DIRS))
    for folder in dirs:
        if not (hasattr(folder, "is_dir") and hasattr(folder, "iterdir")):
            raise PluginError(
                f"{_DIRS} returned {_shown(folder)}; write importlib.resources.files(__name__) "
                "/ 'suites', or a pathlib.Path"
            )
    data = _data_digest(components)
    found = listed if later else components
    return replace(plugin, components=found, scenario_dirs=dirs, data=data)


def _components(
    manager: pluggy.PluginManager, plugin: Plugin, hook: str, category: str
) -> Components:
    """What one hook of a plugin lists, checked."""
    found = tuple(_returned(manager, hook))
    for item in found:
        _check_component(plugin, hook, category, item)
    return found


def _data_digest(components: Sequence[Component[Any]]) -> str:
    """SHA-256 of the files that specs declare in ``data``, relative to where they are written.

    Raises:
        InputError: a name matches no file.
    """
    found: dict[str, Path] = {}
    for component in components:
        if patterns := declared_data(component.spec):
            folder = Path(inspect.getfile(component.spec)).parent
            files = data_files(folder, patterns)
            found |= {f"{component.kind}/{name}": file for name, file in files.items()}
    return digest_of_files(found) if found else ""


def _check_hooks(manager: pluggy.PluginManager, module: Any) -> None:
    """Hooks that do not exist, and functions named like one that are not."""
    known = [*HOOKS, _DIRS]
    hooks = {name: getattr(manager.hook, name) for name in vars(manager.hook) if name[0] != "_"}
    for name, hook in hooks.items():
        if not hook.has_spec() and not all(i.optionalhook for i in hook.get_hookimpls()):
            raise PluginError(f"unknown hook '{name}'{did_you_mean(nearest(name, known)[:1])}")
    marked = {n for n, hook in hooks.items() if hook.get_hookimpls()}
    for name in known:
        if name not in marked and inspect.isroutine(getattr(module, name, None)):
            raise PluginError(f"'{name}' is not marked as a hook: write @hookimpl above it")
    if not marked:
        what = getattr(module, "__name__", type(module).__name__)
        raise PluginError(f"{what} has no hook: no function is marked with @hookimpl")


def _returned(manager: pluggy.PluginManager, hook: str) -> Iterator[Any]:
    """All that the implementations of one hook list; usually there is one, or none."""
    for implementation in getattr(manager.hook, hook).get_hookimpls():
        answer = implementation.function()
        if not isinstance(answer, list | tuple):
            raise PluginError(f"{hook} returned {_shown(answer)}; a list is wanted")
        yield from answer


def _check_component(plugin: Plugin, hook: str, category: str, component: Any) -> None:
    if not isinstance(component, Component):
        raise PluginError(f"{hook} returned {_shown(component)}; a Component is wanted")
    kind = _literal_kind(component)
    if component.category != category:
        raise PluginError(f"{hook} returned {kind}, a {component.category}")
    begin, rest = ("", _NAME) if plugin.name == BUILTIN else (f"{plugin.name}.", _AFTER_DOT)
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
    """The kind of a component whose spec says it the way it must be said."""
    spec = component.spec
    if not (inspect.isclass(spec) and issubclass(spec, ComponentSpec)):
        raise PluginError(
            f"{_shown(spec)} is not a spec: it must derive from one of those in crowdbot.plugin"
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
    """Whether a component's parts are of a category after its own: nothing can contain itself."""
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
    """Whether documents can be read with the specs, alone and beside others.

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
        raise TypeError("a field has a type that is not defined")


def _check_twice(components: Sequence[Component[Any]]) -> None:
    seen: set[tuple[str, str]] = set()
    for component in components:
        key = (component.category, component.kind)
        if key in seen:
            raise PluginError(f"E301 {key[0]} '{key[1]}' is provided twice")
        seen.add(key)


def _shown(value: Any) -> str:
    """A value and its type, in a few words."""
    try:
        text = repr(value)
    except Exception as error:
        text = f"something whose repr raises {type(error).__name__}"
    text = text if len(text) <= 60 else f"{text[:57]}..."
    return text if value is None else f"{text} ({type(value).__name__})"
