"""Find plugins: entry points of installed distributions, and given paths.

Errors are data: a plugin that cannot be loaded is listed with its error and does not affect others.
pluggy's own loading stops at the first failing plugin, and silently drops all but one of those that
share a name.
"""

from __future__ import annotations

import json
import os
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path

from crowdbot.core.registry.loader import failed, load_plugin
from crowdbot.core.registry.plugin import BUILTIN, Plugin
from crowdbot.core.registry.plugin_errors import telling_interrupts
from crowdbot.core.registry.plugin_path import GROUP, PluginEntry, entries_at, place_digest
from crowdbot.errors import PluginError

#: Environment variable with the names of allowed plugins.
ALLOW = "CROWDBOT_PLUGINS"
_SECTION = re.compile(rf"^\s*\[\s*{GROUP}\s*\]", re.MULTILINE)
_OURS = "crowdbot"


@dataclass(frozen=True, slots=True, kw_only=True)
class Discovery:
    """The result of the search.

    Attributes:
        plugins: all plugins that were loaded or failed.
        excluded: installed but not allowed plugins; they were not imported.
        allowed: the allow-list; None allows all.
    """

    plugins: tuple[Plugin, ...]
    excluded: tuple[Plugin, ...] = ()
    allowed: tuple[str, ...] | None = None


def find_plugins(
    *, extra: Sequence[Path] = (), allow: Iterable[str] | None = None, entry_points: bool = True
) -> Discovery:
    """Load installed and allowed plugins, and those at given paths.

    Args:
        extra: paths of plugins that are not installed; always allowed.
        allow: only these plugin names; default: ``CROWDBOT_PLUGINS``, else all.
        entry_points: False reads no entry points except crowdbot's own.
    """
    if allow is None and os.environ.get(ALLOW, "").strip():
        allow = os.environ[ALLOW].split(",")
    names = None if allow is None else tuple(n for n in (a.strip() for a in allow) if n)
    given = [entry for path in extra for entry in entries_at(path)]
    own = {(e.plugin.name, e.plugin.file) for e in given if e.plugin.file}
    chosen: list[PluginEntry] = []
    excluded: list[PluginEntry] = []
    for entry in _installed():
        ours = entry.plugin.name == BUILTIN
        if (entry.plugin.name, entry.plugin.file) in own or not (entry_points or ours):
            continue  # the given path is this plugin
        allowed = ours or names is None or entry.plugin.name in names
        (chosen if allowed else excluded).append(entry)
    with telling_interrupts():
        loaded = tuple(_load([*chosen, *given]))
    return Discovery(
        plugins=loaded,
        excluded=tuple(e.plugin for e in excluded),
        allowed=names,
    )


def _load(entries: Sequence[PluginEntry]) -> Iterator[Plugin]:
    """Load plugins; those that share a name are not imported, since all will be disabled."""
    names = Counter(e.plugin.name for e in entries if not e.plugin.error)
    for entry in entries:
        unique = names[entry.plugin.name] == 1 and not entry.plugin.error
        yield load_plugin(entry.plugin, entry.load) if unique else entry.plugin


def _installed() -> list[PluginEntry]:
    """Return the entry points of all distributions; of duplicates, those of the first.

    The first on ``sys.path`` is the one that Python would import.
    """
    seen: set[str] = set()
    entries: list[PluginEntry] = []
    for distribution in metadata.distributions():
        text = _entry_points(distribution)
        if text is None or _SECTION.search(text) is None:
            continue
        title, version = _title(distribution)
        key = re.sub(r"[-_.]+", "-", title).lower()
        if key not in seen:
            seen.add(key)
            entries += _entries(distribution, f"{title} {version}", ours=key == _OURS)
    return sorted(entries, key=lambda e: (e.plugin.name, e.plugin.distribution, e.plugin.file))


def _entry_points(distribution: metadata.Distribution) -> str | None:
    try:
        return distribution.read_text("entry_points.txt")
    except (OSError, UnicodeDecodeError):
        return None


def _title(distribution: metadata.Distribution) -> tuple[str, str]:
    """Return name and version, as far as they can be read."""
    try:
        name, version = distribution.metadata["Name"], distribution.metadata["Version"]
    except Exception:
        return _folder(distribution) or "unknown", "?"
    return str(name or _folder(distribution) or "unknown"), str(version or "?")


def _folder(distribution: metadata.Distribution) -> str:
    path = getattr(distribution, "_path", None)
    return str(path) if path else ""


def _entries(
    distribution: metadata.Distribution, title: str, *, ours: bool
) -> Iterator[PluginEntry]:
    """Yield the entries of one distribution without duplicates."""
    listed = {(e.name, e.value): e for e in distribution.entry_points if e.group == GROUP}
    for (name, value), entry in listed.items():
        file = _file(distribution, value)
        plugin = Plugin(name=name, distribution=title, file=file)
        if not ours and _is_editable(distribution):
            plugin = _loose(plugin, value)
        if name == BUILTIN and not ours:
            wrong = PluginError(f"the name '{BUILTIN}' is crowdbot's own")
            plugin = replace(failed(plugin, wrong), traceback="")
        yield PluginEntry(plugin=plugin, load=partial(_import, entry))


def _is_editable(distribution: metadata.Distribution) -> bool:
    """Return True if it is installed with ``pip install -e``, so that its version means nothing."""
    try:
        document = json.loads(distribution.read_text("direct_url.json") or "{}")
        return bool(document.get("dir_info", {}).get("editable", False))
    except (OSError, ValueError, AttributeError):
        return False


def _loose(plugin: Plugin, value: str) -> Plugin:
    """Return a plugin from a folder that may change: not pinned, with the hash of its files."""
    if not plugin.file:
        return replace(plugin, pinned=False)
    file = Path(plugin.file)
    depth = value.partition(":")[0].count(".") + (file.name == "__init__.py")
    place = file.parents[depth - 1] if depth else file
    try:
        return replace(plugin, pinned=False, sha256=place_digest(place))
    except PluginError as error:
        return replace(failed(plugin, error), pinned=False)


def _import(entry: metadata.EntryPoint) -> object:
    if entry.pattern.match(entry.value) is None:
        raise PluginError(f"the entry point '{entry.name} = {entry.value}' names no module")
    return entry.load()


def _file(distribution: metadata.Distribution, value: str) -> str:
    """Return the file of an entry point's module, without importing anything."""
    names = value.partition(":")[0].strip().split(".")
    try:
        roots = [Path(str(distribution.locate_file("")))]
        spec = find_spec(names[0])  # an editable installation keeps its modules elsewhere
    except (ImportError, OSError, ValueError):
        return ""
    if spec is not None and spec.origin:
        roots.append(Path(spec.origin).parents[1 if spec.submodule_search_locations else 0])
    places = [root.joinpath(*names) for root in roots]
    files = [f for p in places for f in (p / "__init__.py", p.with_name(f"{p.name}.py"))]
    return next((str(f.resolve()) for f in files if f.is_file()), "")
