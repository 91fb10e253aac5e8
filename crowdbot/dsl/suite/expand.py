"""Expand a document to an ordered list of scenarios: nodes -> merge -> matrix -> validate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from crowdbot.dsl.checks.pydantic_errors import locate
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expander import Expander, sorted_problems
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.include import Loader
from crowdbot.dsl.suite.installed import Installed
from crowdbot.dsl.suite.suite import ParsedSuite, read_suite
from crowdbot.dsl.text.diagnostics import Mark
from crowdbot.dsl.text.finder import Finder, Roots
from crowdbot.dsl.text.nodes import Node
from crowdbot.errors import SpecError

#: Errors after which the rest of a document is still checked.
_GO_ON = frozenset(
    ("E003", "E102", "E103", "E111", "E112", "E116", "E014", "E120", "E121", "E204", "E205",
     "E208", "E210", "E211", "E212", "E214", "E215")
)  # fmt: skip


def load_document(
    path: Path,
    roots: Roots | None = None,
    *,
    name: str = "",
    installed: Installed | None = None,
) -> ParsedSuite:
    """Read a suite or scenario file and everything it extends.

    Args:
        path: the file.
        roots: plugin name -> packaged folders that ``extends`` may read.
        name: name of the file in messages; default: the given path.
        installed: the installed components; None leaves metrics and versions unchecked.

    Raises:
        SpecError: the document cannot be parsed; with all errors found so far.
    """
    loader = Loader(path, roots or {})
    root = loader.load(name or str(path))
    problems = loader.problems
    if all(d.code in _GO_ON for d in problems):
        suite = read_suite(root, problems, installed)
        if suite is not None and all(d.code in _GO_ON for d in problems):
            finder = Finder(path, roots or {})
            return replace(suite, finder=finder, included=tuple(loader.files))
    raise SpecError(sorted_problems(problems))


def expand_document(
    suite: ParsedSuite, scenario_model: type[Scenario], overrides: Sequence[str] = ()
) -> Expansion:
    """Expand and validate all scenarios of a document.

    Args:
        suite: from `load_document`.
        scenario_model: `Scenario`, narrowed to the installed components.
        overrides: ``key=value`` with a dotted key and a YAML value, applied to every scenario.

    Raises:
        SpecError: all errors of all scenarios, without duplicates.
        UsageError: an override is not ``key=value``.
    """
    return Expander(suite, scenario_model, overrides).run()


class Expanding:
    """The scenarios of a document by index, each expanded on demand."""

    def __init__(
        self, suite: ParsedSuite, scenario_model: type[Scenario], overrides: Sequence[str] = ()
    ) -> None:
        self._expander = Expander(suite, scenario_model, overrides)

    def scenario(self, index: int) -> Scenario:
        """Return one scenario.

        Raises:
            SpecError: with the errors of the scenarios expanded so far.
        """
        return self._expander.one(index)


def where(tree: Node, *path: str) -> Mark | None:
    """Return the position of a value, or None for a default."""
    place = locate(tree, path)
    return None if place.rest else place.node.mark
