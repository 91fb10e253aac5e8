"""A complete scenario, each value with its source position."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from crowdbot.dsl.checks.pydantic_errors import locate
from crowdbot.dsl.identity.canonical import plain
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.text.nodes import Node

_COLUMN = 48


def explain_yaml(scenario: Scenario, tree: Node) -> str:
    """Return YAML with ``# from file:line`` behind each value, or ``# default``.

    Args:
        scenario: a validated scenario.
        tree: its merged tree.
    """
    lines = ["crowdbot: 1", "scenario:", *_lines(plain(scenario), tree, ())]
    return "\n".join(lines) + "\n"


def _lines(content: dict[str, Any], tree: Node, path: tuple[str, ...]) -> Iterator[str]:
    for key, value in content.items():
        here = (*path, key)
        indent = "  " * len(here)
        if isinstance(value, dict) and value:
            yield f"{indent}{key}:"
            yield from _lines(value, tree, here)
        else:
            text = f"{indent}{key}: {json.dumps(value, ensure_ascii=False)}"
            yield f"{text:<{_COLUMN}}  # {_origin(tree, here)}"


def _origin(tree: Node, path: tuple[str, ...]) -> str:
    if path == ("id",) and tree.child("id") is None:
        return "labels of the matrix"
    place = locate(tree, path)
    if place.rest and (place.node.entries or not place.path):
        return "default"
    return f"from {place.node.mark.source.name}:{place.node.mark.line + 1}"
