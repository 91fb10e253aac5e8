"""What a document asks of the installation: metrics by name, components by kind and version."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase

from crowdbot.dsl.diagnostics import Diagnostic, Mark
from crowdbot.dsl.nodes import Node
from crowdbot.dsl.validation import missing_package
from crowdbot.errors import did_you_mean, nearest


@dataclass(frozen=True, slots=True)
class Installed:
    """What is installed, as far as a document speaks of it.

    Attributes:
        metrics: kinds of the metrics.
        versions: kind of any component -> its spec_version and the distribution that has it.
    """

    metrics: Collection[str]
    versions: Mapping[str, tuple[int, str]]


def check_metrics(listed: Node | None, known: Collection[str], problems: list[Diagnostic]) -> None:
    """Names and patterns that fit no metric."""
    if listed is None or not isinstance(listed.value, tuple):
        return
    for item in listed.value:
        name = item.value
        if isinstance(name, str) and not any(fnmatchcase(kind, name) for kind in known):
            hint = did_you_mean(nearest(name, known)).removeprefix("; ")
            problems.append(Diagnostic("E121", f"unknown metric '{name}'", item.mark, hint))


def check_versions(
    wanted: Node | None, known: Mapping[str, tuple[int, str]], problems: list[Diagnostic]
) -> None:
    """Components older than those the document was written for."""
    for kind, key, node in _leaves(wanted) if wanted else ():
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
