"""``crowdbot plugins new``: create a starter package."""

from __future__ import annotations

import keyword
import os
import re
import shutil
from collections.abc import Iterator
from importlib import metadata
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from string import Template

from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.registry import Registry
from crowdbot.errors import InputError

_SUFFIX = ".tmpl"
#: A template folder whose name depends on the plugin's.
_PACKAGE = "package"
_HIDDEN = "dot_"


def write_package(
    name: str, out: Path | None, registry: Registry, template: str = "plugin"
) -> Path:
    """Write a plugin package atomically.

    Args:
        name: name of the plugin.
        out: the new folder; default: ``crowdbot-NAME`` here.
        registry: the installed plugins, whose names are taken.
        template: folder of the template: ``plugin``, or ``planner`` for one planner alone.

    Returns:
        The folder.

    Raises:
        InputError: the name is invalid, the folder exists, or it cannot be written.
    """
    _check_name(name, registry)
    folder = out or Path(f"crowdbot-{name.replace('_', '-')}")
    if os.path.lexists(folder):
        raise InputError(f"{folder} exists already; name another folder with --out")
    partial = folder.with_name(f".{folder.name}.{os.getpid()}.part")
    try:
        _write(name, partial, template)
        partial.rename(folder)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror}") from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    return folder


def _check_name(name: str, registry: Registry) -> None:
    if re.fullmatch(r"[a-z][a-z0-9_]*", name) is None:
        fit = re.sub(r"[^a-z0-9_]+", "_", name.lower()).strip("_").lstrip("0123456789")
        advice = f"; '{fit}' would do" if fit else ""
        raise InputError(
            f"'{name}' is not a name for a plugin: lower-case letters, digits and _ after a first "
            f"letter{advice}"
        )
    if name == BUILTIN or keyword.iskeyword(name):
        raise InputError(
            f"'{name}' cannot be the name of a plugin: Python or crowdbot uses it; choose "
            "another name"
        )
    taken: dict[str, Plugin] = {p.name: p for p in (*registry.plugins, *registry.excluded)}
    if name in taken:
        raise InputError(f"'{name}' is the name of a plugin of {taken[name].distribution} already")


def _write(name: str, folder: Path, template: str) -> None:
    words = {
        "name": name,
        "dashed": name.replace("_", "-"),
        "version": metadata.version("crowdbot"),
    }
    for path, text in _templates(files("crowdbot") / "templates" / template):
        parts = [f"crowdbot_{name}" if p == _PACKAGE else _shown(p) for p in path]
        file = folder.joinpath(*parts)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(Template(text).substitute(words), encoding="utf-8")


def _shown(part: str) -> str:
    part = part.removesuffix(_SUFFIX)
    return f".{part.removeprefix(_HIDDEN)}" if part.startswith(_HIDDEN) else part


def _templates(
    folder: Traversable, above: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield path and text of each template below a folder."""
    for item in sorted(folder.iterdir(), key=lambda i: i.name):
        path = (*above, item.name)
        if item.is_dir():
            yield from _templates(item, path)
        elif item.name.endswith(_SUFFIX):
            yield path, item.read_text(encoding="utf-8")
