"""A cache of validated parts, so that a large suite validates each once.

Combinations share nodes that no axis changes. A part is identified by its node; the caller keeps
the nodes alive.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from crowdbot.dsl.text.nodes import Node

#: Depth of parts: ``crowd.streams.in.origin`` is one, its members are not.
_DEPTH = 4


class ValidParts:
    """Node of a part -> the validated part."""

    def __init__(self) -> None:
        self._known: dict[int, Any] = {}

    def add(self, tree: Node, validated: object) -> None:
        """Add the parts of a validated document."""
        self._add(tree, validated, 0)

    def fill(self, tree: Node, data: Mapping[str, Any]) -> dict[str, Any]:
        """Return the document's data with known parts in place of their data."""
        filled: dict[str, Any] = self._fill(tree, data, 0)
        return filled

    def _add(self, node: Node, validated: object, depth: int) -> None:
        for key, entry in node.entries.items():
            if id(entry.node) in self._known:
                continue
            part = validated.get(key) if isinstance(validated, dict) else None
            part = getattr(validated, key, None) if isinstance(validated, BaseModel) else part
            if not isinstance(part, BaseModel | dict):
                continue
            if isinstance(part, BaseModel):
                self._known[id(entry.node)] = part
            if depth + 1 < _DEPTH:
                self._add(entry.node, part, depth + 1)

    def _fill(self, node: Node, data: Any, depth: int) -> Any:
        if depth > 0 and (known := self._known.get(id(node))) is not None:
            return known
        if depth == _DEPTH or not node.entries or not isinstance(data, dict):
            return data
        entries = node.entries
        return {
            key: self._fill(entries[key].node, value, depth + 1) if key in entries else value
            for key, value in data.items()
        }
