"""Values that are set for all scenarios of a document, such as by ``--set``."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.dsl.text.merge import merge, undot
from crowdbot.dsl.text.nodes import Entry, Node, parse
from crowdbot.errors import SpecError, UsageError


def parse_overrides(overrides: Sequence[str], problems: list[Diagnostic]) -> Node:
    """Parse ``key=value`` texts into one tree, later ones over earlier ones."""
    tree = Node(Mark(Source("--set")), {}, implied=True)
    for text in overrides:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise UsageError(f"--set {text}: write key=value, e.g. --set crowd.speed.mean='1 m/s'")
        if key.split(".")[0] in ("id", "references"):
            raise UsageError(f"--set {text}: '{key}' cannot be set")
        source = Source("--set", (text,))
        try:
            node = parse(value, source, problems, shift=len(key) + 1)
        except SpecError as error:
            problems += [d for d in error.diagnostics if d not in problems]
            continue
        entry = Entry(Mark(source, 0, 0, len(key)), node)
        tree = merge(tree, undot(Node(entry.key, {key: entry}, implied=True), problems))
    return tree
