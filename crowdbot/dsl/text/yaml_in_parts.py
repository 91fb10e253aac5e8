"""Documents that repeat one another, written as YAML: what was written before is not again.

The scenarios of a suite have most of their words in common, and a run writes three of them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from crowdbot.dsl.text.plain_yaml import to_yaml

#: Maps down to this one are taken apart: a scenario's robots, and what its crowd consists of.
_DEEPEST = 2
#: Characters of a name by which something is taken apart.
_LONGEST = 40


def to_yaml_in_parts(document: dict[str, Any]) -> str:
    """What `to_yaml` makes of a document that has a map or list in it."""
    return "".join(_entries(document, 0))


def _entries(document: dict[str, Any], depth: int) -> Iterator[str]:
    for key, value in document.items():
        if depth < _DEEPEST and _is_word(key) and isinstance(value, dict) and _is_block(value):
            yield f"{_before(key, depth)}\n"
            yield from _entries(value, depth + 1)
        else:
            yield _entry(key, json.dumps(value), depth)


def _is_word(key: str) -> bool:
    """Whether a key stands before its value on one line; long and strange ones do not."""
    return key.isascii() and key.isidentifier() and len(key) <= _LONGEST


def _is_block(document: dict[str, Any]) -> bool:
    """Whether each of its entries has lines of its own; some of the others have, too."""
    return any(isinstance(value, dict | list) for value in document.values())


@lru_cache(maxsize=512)
def _entry(key: str, value: str, depth: int) -> str:
    """The lines of an entry in a map so deep."""
    return _below(key, json.loads(value), depth)


@lru_cache(maxsize=512)
def _before(key: str, depth: int) -> str:
    """The line before the entries of a map."""
    return _below(key, {"_": []}, depth).partition("\n")[0]


def _below(key: str, value: object, depth: int) -> str:
    document: dict[str, Any] = {"_": [], key: value}
    for _ in range(depth):
        document = {"_": document}
    return to_yaml(document).split("\n", depth + 1)[-1]
