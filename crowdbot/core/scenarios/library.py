"""Open suites by path or packaged name, and select scenarios by id, prefix or pattern."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import cache, cached_property, partial
from pathlib import Path
from typing import Any, Self

from crowdbot.core.registry.registry import Registry, registry_of
from crowdbot.core.registry.registry_source import Whereabouts, whereabouts
from crowdbot.core.scenarios.plugin_folders import _UNPACKED, plugin_folders
from crowdbot.core.support.gc_throttle import throttled_gc
from crowdbot.core.support.text_files import suggest_files
from crowdbot.dsl.scenario.lock import LockFiles
from crowdbot.dsl.scenario.scenario import Locked, Scenario
from crowdbot.dsl.suite.expand import Expanding, expand_document, load_document
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.installed import Installed
from crowdbot.dsl.suite.suite import ParsedSuite
from crowdbot.dsl.text.diagnostics import Diagnostic
from crowdbot.errors import InputError, SpecError, UnknownNameError, nearest

_BUILTIN = "builtin"
#: Errors about something missing in all plugins: kind, metric, file.
_UNKNOWN = ("E120", "E121", "E201")


@dataclass(frozen=True, slots=True)
class OpenDocument:
    """A document after reading: its file, its name for messages, and its contents."""

    path: Path
    name: str
    suite: ParsedSuite


@throttled_gc()
def open_document(spec: str, registry: Registry) -> OpenDocument:
    """Read a suite or scenario with everything it extends, without expanding it.

    Raises:
        SpecError: the document cannot be parsed.
        UnknownNameError: neither a file nor a packaged suite has this name.
    """
    roots = plugin_folders(registry)
    path, name = _find(spec, roots, registry)
    try:
        suite = load_document(path, roots, name=name, installed=installed(registry))
    except SpecError as error:
        raise SpecError([_with_reason(d, registry) for d in error.diagnostics]) from None
    if suite.problems:
        raise SpecError([_with_reason(d, registry) for d in suite.problems])
    return OpenDocument(path, name, suite)


def open_spec(spec: str, registry: Registry, overrides: Sequence[str] = ()) -> Expansion:
    """Read, expand and validate a suite or scenario.

    Args:
        spec: a path, or the name of a packaged suite (``challenge-2020``, ``acme:office``).
        registry: the installed components.
        overrides: ``key=value`` texts, applied to every scenario.

    Raises:
        SpecError: the document is invalid; with all errors.
        UnknownNameError: neither a file nor a packaged suite has this name.
    """
    expansion, _ = open_suite(spec, registry, overrides)
    return expansion


@throttled_gc()
def open_suite(
    spec: str, registry: Registry, overrides: Sequence[str] = ()
) -> tuple[Expansion, LockFiles]:
    """Read, expand and validate a suite, and find its lock files, which need not exist."""
    roots = plugin_folders(registry)
    path, name = _find(spec, roots, registry)
    try:
        suite = load_document(path, roots, name=name, installed=installed(registry))
        expansion = expand_document(suite, registry.scenario_model, overrides)
    except SpecError as error:
        raise SpecError([_with_reason(d, registry) for d in error.diagnostics]) from None
    files = LockFiles(path, spec)
    if files.lock_path.exists():
        _attach(expansion, files, _Origins(suite, registry, expansion, overrides, spec))
    return expansion, files


def _with_reason(diagnostic: Diagnostic, registry: Registry) -> Diagnostic:
    """Add the reason to an error about a plugin that failed or is not allowed."""
    if diagnostic.code not in _UNKNOWN:
        return diagnostic
    quoted = re.search(r"'([^']+)'", diagnostic.message)
    why = registry.why_absent(quoted[1]) if quoted else ""
    return replace(diagnostic, hint=why) if why else diagnostic


def check_writable(files: LockFiles) -> None:
    """Check that a lock may be written to its place.

    Raises:
        InputError: it would be inside an installed package.
    """
    folder = files.lock_path.parent.resolve()
    installed_ = {"site-packages", "dist-packages"} & set(folder.parts)
    if installed_ or any(part.startswith(_UNPACKED) for part in folder.parts):
        raise InputError(
            f"{files.spec} belongs to an installed package, which is not changed; copy its "
            "folder, or write a suite of your own that extends it, and lock that"
        )


class _Origins:
    """The scenarios as in the suite, without ``--set``; each expanded on demand."""

    def __init__(
        self,
        suite: ParsedSuite,
        registry: Registry,
        expansion: Expansion,
        overrides: Sequence[str],
        spec: str,
    ) -> None:
        self._spec = str(Path(spec).resolve()) if Path(spec).is_file() else spec
        self._source = registry.source
        self._given = None if overrides else expansion.scenarios
        self._expanding = Expanding(suite, registry.scenario_model)

    def scenario(self, index: int) -> Scenario:
        return self._given[index] if self._given else self._expanding.scenario(index)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Return itself: a copied scenario has the same origin."""
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """Let another process open the suite again, when it needs it."""
        return _OpenedAgain, (self._spec, whereabouts(self._source))


@dataclass(frozen=True)
class _OpenedAgain:
    """The scenarios of `_Origins` in another process, which opens the suite again."""

    spec: str
    where: Whereabouts

    def scenario(self, index: int) -> Scenario:
        return _expanding(self.spec, self.where).scenario(index)


@cache
def _expanding(spec: str, where: Whereabouts) -> Expanding:
    registry = registry_of(where)
    return Expanding(open_document(spec, registry).suite, registry.scenario_model)


def _attach(expansion: Expansion, files: LockFiles, origins: _Origins) -> None:
    for index, scenario in enumerate(expansion.scenarios):
        scenario.lock_to(Locked(files, partial(_origin, origins, index)))


def _origin(origins: _Origins, index: int) -> Scenario:
    """Return a scenario of a suite; a function, since cloudpickle keeps the class of a method."""
    return origins.scenario(index)


def installed(registry: Registry) -> Installed:
    """Return the installed components, by the names used in documents."""
    return _InstalledIn(registry)


@dataclass(frozen=True)
class _InstalledIn:
    """The registry's components, looked up on demand."""

    registry: Registry

    @property
    def metrics(self) -> Collection[str]:
        return self.registry.components("metric")

    @cached_property
    def versions(self) -> Mapping[str, tuple[int, str]]:
        plugins = self.registry.plugins
        return {c.kind: (c.spec_version, p.distribution) for p in plugins for c in p.components}


def suite_names(registry: Registry) -> list[str]:
    """Return the names of all packaged suites."""
    return sorted(_packaged(plugin_folders(registry)))


def pick(expansion: Expansion, pattern: str | None) -> Scenario:
    """Return the only scenario that matches an id.

    Args:
        expansion: from `open_spec`.
        pattern: an id, a unique prefix or pattern of one, with or without ``suite-id/`` in front;
            None: the only scenario.

    Raises:
        UnknownNameError: no scenario has such an id.
        InputError: several scenarios match.
    """
    if pattern is None:
        return _only(expansion, expansion.scenarios, "no id was given")
    found = select(expansion, pattern)
    exact = [s for s in found if s.id == _bare(expansion, pattern)]
    if not found:
        prefix = f"{expansion.suite_id}/" if "/" in pattern else ""
        known = [prefix + s.id for s in expansion.scenarios]
        raise UnknownNameError("scenario", pattern, _like(pattern, known))
    return _only(expansion, exact or found, f"'{pattern}' fits more than one")


def _like(pattern: str, ids: Sequence[str]) -> Sequence[str]:
    """Return suggestions for a pattern: beginnings of ids with as many parts as it has."""
    parts = pattern.count("-") + 1
    return sorted({"-".join(i.split("-")[:parts]) for i in ids})


def select(expansion: Expansion, pattern: str) -> list[Scenario]:
    """Return all scenarios whose id equals, begins with, or matches ``pattern`` as a glob.

    A ``+`` suffix of the ids from ``--set`` is optional.
    """
    bare = _bare(expansion, pattern)
    ids = [s for s in expansion.scenarios if bare in (s.id, s.id.partition("+")[0])]
    return ids or [
        s for s in expansion.scenarios if s.id.startswith(bare) or fnmatchcase(s.id, bare)
    ]


def select_any(
    expansion: Expansion, patterns: Sequence[str]
) -> tuple[list[Scenario], tuple[str, ...]]:
    """Return all scenarios that match any pattern, in order, and the patterns without a match.

    Without patterns, all scenarios.
    """
    if not patterns:
        return expansion.scenarios, ()
    matches = {p: select(expansion, p) for p in patterns}
    ids = {s.id for found in matches.values() for s in found}
    chosen = [s for s in expansion.scenarios if s.id in ids]
    return chosen, tuple(p for p, found in matches.items() if not found)


def _bare(expansion: Expansion, pattern: str) -> str:
    return pattern.removeprefix(f"{expansion.suite_id}/")


def _only(expansion: Expansion, scenarios: Sequence[Scenario], why: str) -> Scenario:
    if len(scenarios) == 1:
        return scenarios[0]
    some = ", ".join(s.id for s in scenarios[:3]) + (", …" if len(scenarios) > 3 else "")
    raise InputError(
        f"{why}: {len(scenarios)} scenarios of {expansion.suite_id} match ({some}); "
        "give one id, e.g. from 'crowdbot expand'"
    )


def _find(spec: str, roots: dict[str, list[Path]], registry: Registry) -> tuple[Path, str]:
    """Return the file of a SPEC, and its name for messages."""
    path, packaged = Path(spec), _packaged(roots)
    looks_like_path = path.suffix in (".yaml", ".yml") or os.sep in spec or "/" in spec
    if not looks_like_path and spec in packaged:
        return packaged[spec], _shown(packaged[spec], spec)
    if looks_like_path or os.path.lexists(spec):
        return path, spec
    why = registry.why_absent(spec) if ":" in spec else ""
    if not why and not nearest(spec, packaged):
        why = suggest_files(path).removeprefix("; ")
    raise UnknownNameError("suite", spec, packaged, why)


def _packaged(roots: dict[str, list[Path]]) -> dict[str, Path]:
    """Return name -> file of every packaged suite; crowdbot's own have no prefix."""
    return {
        file.stem if plugin == _BUILTIN else f"{plugin}:{file.stem}": file
        for plugin, folders in roots.items()
        for folder in folders
        for file in sorted(folder.glob("*.yaml"))
    }


def _shown(path: Path, spec: str) -> str:
    """Return a packaged file's name for messages.

    Relative if below the working directory, else as in `extends`.
    """
    if path.is_relative_to(Path.cwd()):
        return str(path.relative_to(Path.cwd()))
    plugin, _, _ = spec.rpartition(":")
    return f"{plugin or _BUILTIN}:{path.name}"
