"""Planners in Python files, named as ``file.py:Class``."""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import inspect
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from crowdbot.core.planning.planner import Planner
from crowdbot.core.registry.plugin_boundary import Exceptions, PluginCall
from crowdbot.core.support.source_digest import imported_names, parsed_source
from crowdbot.core.support.text_files import suggest_files
from crowdbot.errors import CrowdbotError, InputError, PlannerError, did_you_mean, nearest
from crowdbot.old_names import shown_old_names

_METHODS = ("reset", "step")
#: Libraries that are slow to import and start no threads, and modules that prepare them.
_SLOW = {
    "numba": "crowdbot.core.planning.process.warm_numba",
    "scipy": "scipy",
    "torch": "torch",
}


def planner_class(path: Path, name: str) -> type[Any]:
    """Return the class in a file, which is executed.

    Raises:
        InputError: there is no such file, or no such planner in it.
        PlannerError: the file cannot be imported, or raises on access to the class.
    """
    if not path.is_file():
        raise InputError(f"{path}: no such file{suggest_files(path)}")
    module = _import(path)
    # Modules and metaclasses may run code on attribute access.
    with call_of_class(path, name)("cannot be loaded"):
        found = getattr(module, name, None)
        classes = [n for n, v in vars(module).items() if inspect.isclass(v)]
        is_class = inspect.isclass(found)
        missing = missing_methods(found)
    if not is_class:
        raise InputError(f"{path}: no class '{name}'{did_you_mean(nearest(name, classes))}")
    if missing:
        raise InputError(f"{path}: class '{name}' is not a planner: no {' and no '.join(missing)}")
    return cast(type[Any], found)


def call_of_class(path: Path, name: str, passes: Exceptions = CrowdbotError) -> PluginCall:
    """Return the call boundary to a class in a file; its errors name the line."""
    return PluginCall(
        f"planner '{name}' ({path})",
        sources=lambda: {str(path.resolve())},
        error=PlannerError,
        passes=passes,
    )


def _import(path: Path) -> ModuleType:
    """Execute a file under its own module name, with its folder last on the search path."""
    file = path.resolve()
    unique = f"crowdbot_planner_{hashlib.sha256(str(file).encode()).hexdigest()[:12]}"
    spec = importlib.util.spec_from_file_location(unique, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[unique] = module
    if str(file.parent) not in sys.path:
        sys.path.append(str(file.parent))
    call = PluginCall(
        str(path), sources=lambda: {str(file)}, error=PlannerError, passes=PlannerError
    )
    try:
        with call("cannot be imported"), shown_old_names():
            spec.loader.exec_module(module)
    except BaseException as error:
        del sys.modules[unique]
        if "no known parent package" in str(error):
            raise PlannerError(
                f"{error}; a file is not a package: write 'import helper' for helper.py beside it"
            ) from error.__cause__
        raise
    return module


def build_of_class(
    kind: type[Any], parameters: Mapping[str, Any], path: Path, name: str
) -> Planner:
    """Build a planner from a class.

    Raises:
        PlannerError: it cannot be made, or lacks a method.
    """
    with call_of_class(path, name, PlannerError)("cannot be built"):
        return checked_planner(kind(**parameters))


def checked_planner(planner: object) -> Planner:
    """Return a planner, checked as far as possible before calls.

    Raises:
        PlannerError: it lacks a method.
    """
    missing = missing_methods(planner)
    if missing:
        kind = type(planner).__name__
        raise PlannerError(f"what was built, a {kind}, has no {' and no '.join(missing)}")
    return cast(Planner, planner)


def missing_methods(planner: object) -> list[str]:
    """Return the methods that a planner, or its class, lacks."""
    return [m for m in _METHODS if not callable(getattr(planner, m, None))]


def check_parameters(kind: type[Any], parameters: Mapping[str, Any], where: str) -> None:
    """Check that a class accepts some parameters.

    Raises:
        InputError: it has no such parameter, or lacks one.
        PlannerError: the check itself raises.
    """
    call = PluginCall(where, error=PlannerError, passes=(ValueError, TypeError))
    try:
        with call("its parameters"):
            inspect.signature(kind).bind(**parameters)
    except ValueError:  # a class without a signature fails when it is called
        return
    except TypeError as error:
        known = ", ".join(inspect.signature(kind).parameters) or "none"
        raise InputError(f"{where}: {error}; its parameters: {known}") from None


def guess_class(path: Path) -> str:
    """Return the name of the first class in a file with both methods, or ``Class``."""
    tree = parsed_source(path)
    if tree is None:
        return "Class"
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            methods = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            if methods >= set(_METHODS):
                return node.name
    return "Class"


def preloads(path: Path) -> tuple[str, ...]:
    """Return slow libraries that a file, or a module beside it, imports, for importing them once.

    A process with these imports can be forked for every run.
    """
    names = imported_names(path)
    return tuple(module for name, module in _SLOW.items() if name in names)
