"""Plugins that are not installed: a file, a package folder, or a project with pyproject.toml."""

from __future__ import annotations

import importlib
import importlib.util
import sys
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.machinery import PathFinder
from pathlib import Path
from types import ModuleType
from typing import Any

from crowdbot.core.registry.plugin import Plugin
from crowdbot.core.support.source_digest import (
    check_source,
    digest_of_files,
    package_files,
    source_digest,
)
from crowdbot.core.support.text_files import read_text
from crowdbot.errors import InputError, PluginError

#: Entry point group in which a distribution names its plugin module.
GROUP = "crowdbot"
#: Prefix of package folders that is not part of the plugin's name: ``crowdbot_acme`` is ``acme``.
_PREFIX = "crowdbot_"
#: Folders that plugins added to ``sys.path``, kept from shadowing each other.
_ADDED: set[str] = set()


@dataclass(frozen=True, slots=True, kw_only=True)
class PluginEntry:
    """A plugin that was found but not imported yet."""

    plugin: Plugin
    load: Callable[[], Any]


def entries_at(path: Path) -> list[PluginEntry]:
    """Return the plugins at a path; if there is none, an entry that reports it when loaded."""
    try:
        project = _project(path)
        if project is None:
            return [_entry(path, _bare_name(path), path, "")]
        root, declared = project
        return [_entry(path, name, *_located(root, value)) for name, value in declared.items()]
    except PluginError as error:
        plugin = Plugin(name=path.resolve().stem, distribution=str(path), pinned=False, given=True)
        return [PluginEntry(plugin=plugin, load=partial(_fail, str(error)))]


def path_without_plugins() -> list[str]:
    """Return ``sys.path`` without the folders of plugins that are not installed."""
    return [p for p in sys.path if p not in _ADDED]


def load_path(path: Path) -> ModuleType:
    """Import a Python file or a package folder under its own name, without installing it.

    Modules beside it can be imported too, with lower priority than installed ones.

    Raises:
        PluginError: there is no such file, its name is taken, or it cannot be imported.
    """
    file = (path / "__init__.py" if path.is_dir() else path).resolve()
    name = path.resolve().stem
    if not file.is_file():
        raise PluginError(f"{path}: no Python file or package")
    try:
        check_source(file)
    except InputError as error:
        raise PluginError(str(error)) from None
    taken = sys.modules.get(name)
    if taken is not None and getattr(taken, "__file__", None) == str(file):
        return taken
    if taken is not None or _is_installed(name, file):
        raise PluginError(
            f"{path}: a module named '{name}' exists already; rename the plugin, or uninstall "
            "the other one ('pip install -e' runs an installed plugin from its folder)"
        )
    return _import_file(name, file, package=path.is_dir())


def _is_installed(name: str, file: Path) -> bool:
    """Return True if importing that name would find something else."""
    if name in sys.stdlib_module_names:
        return True
    found = PathFinder.find_spec(name, path_without_plugins())
    return found is not None and found.origin != str(file)


def _import_file(name: str, file: Path, *, package: bool) -> ModuleType:
    folders = [str(file.parent)] if package else None
    spec = importlib.util.spec_from_file_location(name, file, submodule_search_locations=folders)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # build references use this name
    beside = str(file.parent.parent if package else file.parent)
    if beside not in sys.path:
        sys.path.append(beside)
        _ADDED.add(beside)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        for loaded in [m for m in sys.modules if m == name or m.startswith(f"{name}.")]:
            del sys.modules[loaded]
        raise
    return module


def _entry(given: Path, name: str, place: Path, value: str) -> PluginEntry:
    file = place / "__init__.py" if place.is_dir() else place
    plugin = Plugin(
        name=name,
        distribution=str(given),
        pinned=False,
        given=True,
        file=str(file.resolve()) if file.is_file() else "",
        sha256=place_digest(place),
    )
    return PluginEntry(plugin=plugin, load=partial(_load, place, value))


def _load(place: Path, value: str) -> Any:
    """Import the module at a location, and the object that an entry point names in it."""
    found: Any = load_path(place)
    module, _, attributes = value.partition(":")
    if "." in module:
        found = importlib.import_module(module)
    for attribute in filter(None, attributes.strip().split(".")):
        found = getattr(found, attribute)
    return found


def _fail(text: str) -> None:
    raise PluginError(text)


def _bare_name(path: Path) -> str:
    stem = path.resolve().stem
    return stem.removeprefix(_PREFIX) if path.is_dir() else stem


def _project(path: Path) -> tuple[Path, Mapping[str, str]] | None:
    """Return root and entry points of the project of a folder or package.

    Raises:
        PluginError: the folder is a project that declares no plugin.
    """
    if not path.is_dir():
        return None
    if (path / "pyproject.toml").is_file() and not (path / "__init__.py").is_file():
        declared = _declared(path / "pyproject.toml")
        if not declared:
            raise PluginError(
                f"{path / 'pyproject.toml'} declares no plugin; it needs "
                f'[project.entry-points.{GROUP}] with NAME = "MODULE"'
            )
        return path, declared
    folder = path.resolve()
    for root in (folder.parent, folder.parent.parent):
        file = root / "pyproject.toml"
        declared = _declared(file) if file.is_file() else {}
        mine = {n: v for n, v in declared.items() if _top(v) == folder.name}
        if mine:
            return root, mine
    return None


def _declared(file: Path) -> dict[str, str]:
    try:
        document = tomllib.loads(read_text(file))
        entries = document.get("project", {}).get("entry-points", {}).get(GROUP, {})
        return {str(name): str(value) for name, value in entries.items()}
    except (OSError, ValueError, AttributeError, RecursionError) as error:
        raise PluginError(f"{file}: cannot be read: {error}") from error


def _top(value: str) -> str:
    return value.partition(":")[0].strip().partition(".")[0]


def _located(root: Path, value: str) -> tuple[Path, str]:
    """Return the top package or module of a project's entry point, beside it or in ``src``."""
    top = _top(value)
    for folder in (root, root / "src"):
        for place in (folder / top, folder / f"{top}.py"):
            if place.is_file() or (place / "__init__.py").is_file():
                return place, value
    raise PluginError(f"{root}: no module '{top}', which its entry point names, here or in src/")


def place_digest(place: Path) -> str:
    """Return the hash of a file or a package's files, and of modules beside it that it needs.

    Raises:
        PluginError: a file cannot be read.
    """
    try:
        return source_digest(place) if place.is_file() else digest_of_files(package_files(place))
    except InputError as error:
        raise PluginError(str(error)) from None
