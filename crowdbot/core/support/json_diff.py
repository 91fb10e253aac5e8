"""Differences between two documents, field by field."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

#: Marks a field that one side does not have.
ABSENT = object()


@dataclass(frozen=True, slots=True)
class Difference:
    """A field, and its value on both sides; `ABSENT` if missing."""

    path: str
    a: Any
    b: Any

    def as_dict(self) -> dict[str, Any]:
        """Return a dictionary for ``--json``; a missing side has no key."""
        sides = {"a": self.a, "b": self.b}
        return {"field": self.path} | {k: v for k, v in sides.items() if v is not ABSENT}


def differences(a: Any, b: Any, path: str = "") -> Iterator[Difference]:
    """Yield differences of two JSON documents by path; maps are followed, lists are not.

    A map with another ``kind`` is one difference, since fields of different types are unrelated. A
    map on one side only is followed, so that each field is shown.
    """
    if isinstance(a, Mapping) and isinstance(b, Mapping) and a.get("kind") == b.get("kind"):
        for key in sorted({*a, *b}):
            below = f"{path}.{key}" if path else str(key)
            yield from differences(a.get(key, ABSENT), b.get(key, ABSENT), below)
    elif not _same(a, b):
        yield Difference(path, a, b)


def shown(value: Any) -> str:
    """Return one side of a difference as readable text."""
    if value is ABSENT:
        return "–"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _same(a: Any, b: Any) -> bool:
    """Return True if equal in value and type: ``1`` and ``true`` differ."""
    if a is ABSENT or b is ABSENT:
        return a is b
    return json.dumps(a, sort_keys=True) == json.dumps(b, sort_keys=True)
