"""Calls the hooks of one plugin, and reports invalid results."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pluggy

from crowdbot import hookspecs
from crowdbot.core.registry.old_hooks import OLD_HOOKS, old_hookspecs
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import CATEGORIES
from crowdbot.errors import PluginError, did_you_mean, nearest

COMPONENTS = "crowdbot_components"
DIRS = "crowdbot_scenario_dirs"
_KNOWN = (COMPONENTS, DIRS, *OLD_HOOKS)


def manager_of(module: Any, name: str) -> pluggy.PluginManager:
    """Return a manager with one plugin, so that an error stays its own.

    Raises:
        PluginError: the module has a hook that does not exist, or none.
    """
    manager = pluggy.PluginManager("crowdbot")
    manager.add_hookspecs(hookspecs)
    manager.add_hookspecs(old_hookspecs())
    manager.register(module, name)
    _check_hooks(manager, module)
    return manager


def listed(manager: pluggy.PluginManager) -> dict[str, list[Component[Any] | str]]:
    """Return the components that a plugin lists: category -> components, and references.

    Raises:
        PluginError: a hook returned something else, or a component of another category.
    """
    found: dict[str, list[Component[Any] | str]] = {c.category: [] for c in CATEGORIES}
    for answer in _answers(manager, COMPONENTS):
        for category, entries in _checked_table(answer).items():
            found[category] += entries
    for hook, category in OLD_HOOKS.items():
        for component in _sequences(manager, hook):
            if not isinstance(component, Component):
                raise PluginError(f"{hook} returned {shown(component)}; a Component is wanted")
            found[category].append(component)
    return {category: entries for category, entries in found.items() if entries}


def scenario_dirs(manager: pluggy.PluginManager) -> tuple[Any, ...]:
    """Return the folders with suites that a plugin lists.

    Raises:
        PluginError: the hook returned something else.
    """
    folders = tuple(_sequences(manager, DIRS))
    for folder in folders:
        if not (hasattr(folder, "is_dir") and hasattr(folder, "iterdir")):
            raise PluginError(
                f"{DIRS} returned {shown(folder)}; write importlib.resources.files(__name__) "
                "/ 'suites', or a pathlib.Path"
            )
    return folders


def shown(value: Any) -> str:
    """Return a value and its type, in a few words."""
    try:
        text = repr(value)
    except Exception as error:
        text = f"something whose repr raises {type(error).__name__}"
    text = text if len(text) <= 60 else f"{text[:57]}..."
    return text if value is None else f"{text} ({type(value).__name__})"


def _check_hooks(manager: pluggy.PluginManager, module: Any) -> None:
    """Refuse hooks that do not exist, and functions named like one that are not."""
    hooks = {name: getattr(manager.hook, name) for name in vars(manager.hook) if name[0] != "_"}
    for name, hook in hooks.items():
        if not hook.has_spec() and not all(i.optionalhook for i in hook.get_hookimpls()):
            near = nearest(name, (COMPONENTS, DIRS)) or nearest(name, _KNOWN)
            raise PluginError(f"unknown hook '{name}'{did_you_mean(near[:1])}")
    marked = {n for n, hook in hooks.items() if hook.get_hookimpls()}
    for name in _KNOWN:
        if name not in marked and inspect.isroutine(getattr(module, name, None)):
            raise PluginError(f"'{name}' is not marked as a hook: write @hookimpl above it")
    if not marked:
        module_name = getattr(module, "__name__", type(module).__name__)
        raise PluginError(f"{module_name} has no hook: no function is marked with @hookimpl")


def _answers(manager: pluggy.PluginManager, hook: str) -> Iterator[Any]:
    """Yield what each implementation of one hook returns; usually there is one, or none."""
    for implementation in getattr(manager.hook, hook).get_hookimpls():
        yield implementation.function()


def _sequences(manager: pluggy.PluginManager, hook: str) -> Iterator[Any]:
    """Yield all that the implementations of one hook list."""
    for answer in _answers(manager, hook):
        if not isinstance(answer, list | tuple):
            raise PluginError(f"{hook} returned {shown(answer)}; a list is wanted")
        yield from answer


def _checked_table(answer: Any) -> Mapping[str, Sequence[Component[Any] | str]]:
    """Return the answer of ``crowdbot_components`` if it is a table of components."""
    if not isinstance(answer, Mapping):
        raise PluginError(
            f"{COMPONENTS} returned {shown(answer)}; a table is wanted: category -> components"
        )
    known = [c.category for c in CATEGORIES]
    for category, entries in answer.items():
        if category not in known:
            near = did_you_mean(nearest(str(category), known)[:1])
            raise PluginError(f"{COMPONENTS}: there is no category {category!r}{near}")
        if not isinstance(entries, list | tuple):
            raise PluginError(f"{COMPONENTS}: {category}: {shown(entries)}; a list is wanted")
        for entry in entries:
            if not isinstance(entry, Component | str):
                raise PluginError(
                    f"{COMPONENTS}: {category}: {shown(entry)}; a Component is wanted, "
                    'or "package.module:NAME"'
                )
    return answer
