"""Requirements of a document on the installation: metrics by name, components by version."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from fnmatch import fnmatchcase
from typing import Protocol

from crowdbot.dsl.checks.pydantic_errors import missing_package
from crowdbot.dsl.text.diagnostics import Diagnostic, Mark
from crowdbot.dsl.text.nodes import Node
from crowdbot.errors import did_you_mean, nearest


class Installed(Protocol):
    """Interface to the installed components that documents refer to."""

    @property
    def metrics(self) -> Collection[str]:
        """Return the kinds of the metrics."""

    @property
    def versions(self) -> Mapping[str, tuple[int, str]]:
        """Return kind of any component -> its spec_version and distribution."""


def check_metrics(listed: Node | None, installed: Installed, problems: list[Diagnostic]) -> None:
    """Check that names and patterns match installed metrics."""
    if listed is None or not isinstance(listed.value, tuple):
        return
    for item in listed.value:
        name, known = item.value, installed.metrics
        if isinstance(name, str) and not any(fnmatchcase(kind, name) for kind in known):
            hint = did_you_mean(nearest(name, known)).removeprefix("; ")
            problems.append(Diagnostic("E121", f"unknown metric '{name}'", item.mark, hint))


def check_versions(versions: Node | None, installed: Installed, problems: list[Diagnostic]) -> None:
    """Check that components are not older than the document requires."""
    for kind, key, node in _leaves(versions) if versions else ():
        known = installed.versions
        if not kind or type(node.value) is not int or node.value < 1:
            text = "kinds wants a map of kinds with their version, a whole number from 1"
            problems.append(Diagnostic("E111", text, node.mark))
        elif kind not in known:
            hint = did_you_mean(nearest(kind, known)).removeprefix("; ") or missing_package(kind)
            problems.append(Diagnostic("E120", f"unknown kind '{kind}'", key, hint))
        elif node.value > known[kind][0]:
            version, distribution = known[kind]
            text = (
                f"the document needs version {node.value} of '{kind}'; "
                f"{distribution} has version {version}"
            )
            hint = f"pip install --upgrade {distribution.split()[0]}"
            problems.append(Diagnostic("E014", text, node.mark, hint))


def _leaves(
    node: Node, path: str = "", key: Mark | None = None
) -> Iterator[tuple[str, Mark, Node]]:
    if not node.entries:
        if path or node.value not in (None, {}):
            yield path, key or node.mark, node
        return
    for name, entry in node.entries.items():
        yield from _leaves(entry.node, f"{path}.{name}" if path else name, key or entry.key)
