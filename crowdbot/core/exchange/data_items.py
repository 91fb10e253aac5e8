"""Parse JSON and YAML files of other programs into items; JSON is read as YAML."""

from __future__ import annotations

from crowdbot.core.exchange.item import Item
from crowdbot.dsl.text.diagnostics import Diagnostic, Source
from crowdbot.dsl.text.nodes import Node, parse
from crowdbot.errors import SpecError


def parse_data(text: str, source: Source) -> Item:
    """Return the root of a document: keys are children by name, entries of lists ``[n]``.

    Raises:
        SpecError: it is not a document that our own reader of YAML accepts.
    """
    problems: list[Diagnostic] = []
    root = parse(text, source, problems)
    if problems:
        raise SpecError(problems)
    return _item("", root)


def _item(name: str, node: Node) -> Item:
    if isinstance(node.value, dict):
        item = Item(name, node.mark)
        for key, entry in node.value.items():
            child = item.add(_item(key, entry.node))
            if child.children or child.value is None:
                child.mark = entry.key
        return item
    if isinstance(node.value, tuple):
        item = Item(name, node.mark)
        for number, part in enumerate(node.value):
            item.add(_item(f"[{number}]", part))
        return item
    return Item(name, node.mark, node.value)
