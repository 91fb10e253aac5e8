"""Write similar documents as YAML, reusing text of repeated parts.

The scenarios of a suite have most of their text in common, and a run writes three of them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from crowdbot.dsl.text.plain_yaml import to_yaml

#: Depth of maps that are split: a scenario's robots, and a crowd's parts.
_DEEPEST = 2
#: Characters of a name that would split something.
_LONGEST = 40


def to_yaml_in_parts(document: dict[str, Any]) -> str:
    """Return the same text as `to_yaml` for a document with nested maps or lists."""
    return "".join(_entries(document, 0))


def _entries(document: dict[str, Any], depth: int) -> Iterator[str]:
    for key, value in document.items():
        if depth < _DEEPEST and _is_word(key) and isinstance(value, dict) and _is_block(value):
            yield f"{_before(key, depth)}\n"
            yield from _entries(value, depth + 1)
        else:
            yield _entry(key, json.dumps(value), depth)


def _is_word(key: str) -> bool:
    """Return True if a key is a short ASCII identifier, which YAML writes without quotes."""
    return key.isascii() and key.isidentifier() and len(key) <= _LONGEST


def _is_block(document: dict[str, Any]) -> bool:
    """Return True if YAML writes a map in block style: it contains a list or a map."""
    return any(isinstance(value, dict | list) for value in document.values())


@lru_cache(maxsize=512)
def _entry(key: str, value: str, depth: int) -> str:
    """Return the lines of an entry in a map at this depth."""
    return _below(key, json.loads(value), depth)


@lru_cache(maxsize=512)
def _before(key: str, depth: int) -> str:
    """Return the line of a key whose value is a block map: the line above its entries."""
    return _below(key, {"_": []}, depth).partition("\n")[0]


def _below(key: str, value: object, depth: int) -> str:
    document: dict[str, Any] = {"_" if key != "_" else "x": [], key: value}
    for _ in range(depth):
        document = {"_": document}
    return to_yaml(document).split("\n", depth + 1)[-1]
