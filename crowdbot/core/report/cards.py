"""Metric cards as plain data for the page."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from crowdbot.core.registry.registry import Registry
from crowdbot.errors import PluginError

#: Rows of a card's first table that the page shows.
_HEAD = ("category", "unit", "better", "range", "sampling", "needs")


def cards(registry: Registry, metrics: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Return metric -> contents of its card; metrics that are not installed are left out."""
    known = registry.components("metric")
    found = {}
    for name in metrics:
        if name not in known:
            continue
        try:
            found[name] = card(known[name].read_card())
        except PluginError:  # a plugin without a card: its scores are still valid
            continue
    return found


def card(text: str) -> dict[str, Any]:
    """Return the parts of a card that are shown beside a table.

    Returns:
        ``summary``, ``head`` (pairs of texts), ``formula``, ``variants`` (name -> definition),
        ``literal``: the literal form's faults.
    """
    front, *rest = re.split(r"^## ", text, flags=re.MULTILINE)
    sections = {s.partition("\n")[0].strip(): s.partition("\n")[2] for s in rest}
    head = {name: text for name, text, *_ in _cells(front)}
    variants = {name.strip("`"): cells[-1] for name, *cells in _cells(sections.get("Variants", ""))}
    return {
        "summary": _summary(front),
        "head": [(name, head[name]) for name in _HEAD if head.get(name)],
        "formula": _unindented(sections.get("Formula", "")),
        "variants": variants,
        "literal": sections.get("What the literal form gets wrong", "").strip(),
    }


def reference(card_: dict[str, Any] | None) -> dict[str, Any] | None:
    """Return the value that means "no effect", if the card's range names one."""
    range_text = dict(card_["head"]).get("range", "") if card_ else ""
    match = re.search(r"; (-?\d+(?:\.\d+)?): ([^;,]+)", range_text)
    return None if match is None else {"value": float(match[1]), "meaning": match[2].strip()}


def _summary(front: str) -> str:
    lines = front.partition("\n")[2].strip().split("\n\n")[0]
    return " ".join(lines.split())


def _cells(text: str) -> list[list[str]]:
    """Return the rows of the first table, without its head."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [re.split(r"(?<!\\)\|", line)[1:-1] for line in lines]
    rows = [[c.strip().replace("\\|", "|") for c in row] for row in cells]
    return [row for row in rows[2:] if len(row) > 1]


def _unindented(text: str) -> str:
    return "\n".join(line.removeprefix("    ") for line in text.strip("\n").splitlines()).strip()
