"""What differs between two documents, field by field."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

#: Stands for a field that one side does not have.
ABSENT = object()


@dataclass(frozen=True, slots=True)
class Difference:
    """A field, and what both sides have there; `ABSENT` where there is nothing."""

    path: str
    a: Any
    b: Any

    def as_dict(self) -> dict[str, Any]:
        """For ``--json``; a side that lacks the field lacks the key."""
        sides = {"a": self.a, "b": self.b}
        return {"field": self.path} | {k: v for k, v in sides.items() if v is not ABSENT}


def differences(a: Any, b: Any, path: str = "") -> Iterator[Difference]:
    """Differences of two documents of JSON values, by path; maps are followed, lists are not.

    A map with another ``kind`` is one difference: fields of two types have nothing in common.
    A map that only one side has is followed, so that each of its fields is seen.
    """
    if isinstance(a, Mapping) and isinstance(b, Mapping) and not _other_kind(a, b):
        for key in sorted({*a, *b}):
            below = f"{path}.{key}" if path else str(key)
            yield from differences(a.get(key, ABSENT), b.get(key, ABSENT), below)
    elif not _same(a, b):
        yield Difference(path, a, b)


def shown(value: Any) -> str:
    """A side of a difference for people."""
    if value is ABSENT:
        return "–"
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _other_kind(a: Mapping[str, Any], b: Mapping[str, Any]) -> bool:
    return a.get("kind") != b.get("kind")


def _same(a: Any, b: Any) -> bool:
    """Equal in value and type: ``1`` and ``true`` are not the same."""
    if a is ABSENT or b is ABSENT:
        return a is b
    return json.dumps(a, sort_keys=True) == json.dumps(b, sort_keys=True)
