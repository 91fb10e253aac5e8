"""Find and hash the assets of a scenario."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

from crowdbot.dsl.checks.pydantic_errors import mark_of
from crowdbot.dsl.scenario.components import components
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.spec.assets import Asset, sha256_of
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.dsl.text.finder import Finder
from crowdbot.dsl.text.nodes import Node


class AssetFiles:
    """The assets of one document; each file is hashed once."""

    def __init__(self, finder: Finder, committed: Mapping[str, str] | None = None) -> None:
        """Create it; ``committed``: path -> sha256 of files that must be unchanged."""
        self._finder = finder
        self._committed = committed or {}
        self._known: dict[Path, str] = {}
        self._complete: dict[int, ComponentSpec] = {}

    def fill(
        self, scenario: Scenario, tree: Node, data: dict[str, Any], problems: list[Diagnostic]
    ) -> dict[str, Any]:
        """Return a scenario's data with its assets found, or ``data`` itself if it has none.

        Args:
            scenario: validated.
            tree: source tree, which knows the file that names the asset.
            data: data of the tree; not changed.
            problems: errors are added.
        """
        for path, asset, spec in self._waiting(scenario):
            mark = _mark(tree, path)
            found = self._found(asset, mark, problems)
            if found is None:
                continue
            data = _replaced(data, path, found)
            named = {} if spec is None else spec.beside(path[-1], found.file)
            for name, text in named.items():
                beside = Asset(path=str(PurePosixPath(asset.path).parent / text))
                other = self._found_beside(beside, f"'{asset.path}' names it", name, mark, problems)
                data = data if other is None else _replaced(data, (*path[:-1], name), other)
        return data

    def _waiting(
        self, scenario: Scenario
    ) -> Iterator[tuple[tuple[str, ...], Asset, ComponentSpec | None]]:
        """Yield path, asset and component of assets not found yet.

        Scenarios share components, so a complete component is checked once.
        """
        figures = {} if scenario.crowd is None else scenario.crowd.body.figures
        for name, figure in figures.items():
            if not figure.is_found:
                yield ("crowd", "body", "figures", name), figure, None
        for path, spec in components(scenario):
            if id(spec) in self._complete:
                continue
            names = [n for n, v in vars(spec).items() if isinstance(v, Asset) and not v.is_found]
            if not names:
                self._complete[id(spec)] = spec  # kept so that its id is not reused
            for name in names:
                yield (*path, name), getattr(spec, name), spec

    def _found_beside(
        self, asset: Asset, why: str, field: str, mark: Mark, problems: list[Diagnostic]
    ) -> Asset | None:
        """Find an asset that another file names, as `_found`; errors add ``why`` and a remedy."""
        own = list[Diagnostic]()
        found = self._found(asset, mark, own)
        for problem in own:
            hint = f"{why}; put it there, or write '{field}' beside 'file'"
            hint = f"{problem.hint}; {hint}" if problem.hint else hint
            problems.append(replace(problem, hint=hint))
        return found

    def _found(self, asset: Asset, mark: Mark, problems: list[Diagnostic]) -> Asset | None:
        """Return an asset with its file located; None without one.

        A missing file is an error, unless the document gives the hash of its content.
        """
        file = self._finder.find(asset.path, mark)
        if isinstance(file, Diagnostic):
            if not (file.code == "E201" and asset.sha256):
                problems.append(file)
            return None
        try:
            digest = self._known.get(file) or self._known.setdefault(file, sha256_of(file))
        except OSError as error:
            reason = error.strerror or str(error)
            text = f"'{asset.path}' cannot be opened: {reason}"
            problems.append(Diagnostic("E201", text, mark))
            return None
        if asset.sha256 not in (None, digest):
            text = f"'{asset.path}' does not have the sha256 written here"
            problems.append(Diagnostic("E213", text, mark, f"its sha256 is {digest}"))
            return None
        name = self._finder.name_of(file)
        if self._committed.get(name) not in (None, digest):
            text = f"'{name}' was changed after the commitment"
            problems.append(
                Diagnostic("E213", text, mark, "restore it; suite.files has its sha256")
            )
            return None
        return Asset.at(file, name, digest)


def asset_hashes(scenarios: Iterable[Scenario]) -> dict[str, str]:
    """Return path -> sha256 of all files that scenarios and their references name, by path."""
    found = dict[str, str]()
    for scenario in scenarios:
        for one in (scenario, *scenario.references.values()):
            figures = {} if one.crowd is None else one.crowd.body.figures
            fields = [v for _, spec in components(one) for v in vars(spec).values()]
            assets = [v for v in (*figures.values(), *fields) if isinstance(v, Asset)]
            found |= {a.path: a.sha256 for a in assets if a.sha256}
    return dict(sorted(found.items()))


def _mark(tree: Node, path: tuple[str, ...]) -> Mark:
    """Return the position of an asset's path, in either of its forms."""
    return mark_of(tree, *path, "path")


def _replaced(data: dict[str, Any], path: tuple[str, ...], value: object) -> dict[str, Any]:
    """Return a copy with another value under a path."""
    key, *rest = path
    return {**data, key: _replaced(data[key], tuple(rest), value) if rest else value}
