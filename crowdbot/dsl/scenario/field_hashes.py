"""Short hashes of scenarios' fields, to name what changed since a suite was locked.

Fields that all scenarios share have a hash each. The other fields are grouped by place, such as
``robots.robot.sensors``, and each scenario has one hash for each of these places.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

Values = dict[str, Any]

#: Hexadecimal digits of a field's hash. It only names a change; the spec hash finds it.
_DIGITS = 8
#: Fields that differ between scenarios are grouped by this many parts of their paths.
_DEPTH = 3
#: Longest value that a message shows, characters.
_SHOWN = 80


class FieldHashes(NamedTuple):
    """Hashes of the fields of all scenarios of a suite.

    Attributes:
        common: path -> hash of each field that is equal in all scenarios.
        places: paths at or below which scenarios differ.
        varied: scenario -> hash of its fields at each of the places.
    """

    common: dict[str, str]
    places: tuple[str, ...]
    varied: dict[str, tuple[str, ...]]


def hash_fields(scenarios: Mapping[str, Values]) -> FieldHashes:
    """Return the hashes of scenarios' fields, given by dotted path (see `flatten`)."""
    listed = [{path: _hash(value) for path, value in v.items()} for v in scenarios.values()]
    first = listed[0] if listed else {}
    common = {
        path: mark for path, mark in first.items() if all(v.get(path) == mark for v in listed)
    }
    places = _places({path for v in listed for path in v if path not in common})
    varied = {
        name: tuple(_hash(below) for below in _by_place(places, _others(common, values)).values())
        for name, values in scenarios.items()
    }
    return FieldHashes(common, places, varied)


def changed_fields(
    common: Mapping[str, str], places: Sequence[str], varied: Sequence[str], values: Values
) -> Iterator[str]:
    """Yield the changes in one scenario since it was hashed, field by field, in words.

    Args:
        common, places, varied: as in `FieldHashes`, of this scenario.
        values: its fields now.
    """
    for path, mark in common.items():
        if path not in values:
            yield f"{path}: gone"
        elif _hash(values[path]) != mark:
            yield f"{path}: changed, now {_show(values[path])}"
    others = _others(common, values)
    now = _by_place(places, others)
    for (place, below), mark in zip(now.items(), varied, strict=True):
        if _hash(below) != mark:
            yield _of_place(place, below)
        others = {path: value for path, value in others.items() if path not in below}
    for path, value in others.items():
        yield f"{path}: new, {_show(value)}"


def _of_place(place: str, below: Values) -> str:
    if not below:
        return f"{place}: gone"
    if len(below) == 1:
        ((path, value),) = below.items()
        return f"{path}: changed, now {_show(value)}"
    return f"{place}: changed"


def _others(common: Mapping[str, str], values: Values) -> Values:
    return {path: value for path, value in values.items() if path not in common}


def _places(paths: Iterable[str]) -> tuple[str, ...]:
    """Group dotted paths by their first names; return each group's longest common start."""
    groups: dict[tuple[str, ...], list[list[str]]] = {}
    for path in sorted(paths):
        parts = path.split(".")
        groups.setdefault(tuple(parts[:_DEPTH]), []).append(parts)
    return tuple(".".join(_shared_start(group)) for group in groups.values())


def _shared_start(group: Sequence[Sequence[str]]) -> list[str]:
    start = []
    for parts in zip(*group, strict=False):
        if len(set(parts)) > 1:
            break
        start.append(parts[0])
    return start


def _by_place(places: Sequence[str], values: Values) -> dict[str, Values]:
    """Return place -> fields at or below it; each field is listed at its innermost place only."""
    found: dict[str, Values] = {place: {} for place in places}
    for path, value in values.items():
        parts = path.split(".")
        starts = (".".join(parts[:n]) for n in range(len(parts), 0, -1))
        place = next((start for start in starts if start in found), None)
        if place is not None:
            found[place][path] = value
    return found


def flatten(content: Any, path: str = "") -> Values:
    """Return a document as dotted path -> value; empty maps count as values."""
    if not isinstance(content, dict) or (path and not content):
        return {path: content}
    values: Values = {}
    for key, value in content.items():
        values |= flatten(value, f"{path}.{key}" if path else key)
    return values


def changes(old: Values, new: Values) -> Iterator[str]:
    """Yield the changes between two scenarios, field by field, in words."""
    for path in sorted({*old, *new}):
        if path not in old:
            yield f"{path}: new, {json.dumps(new[path])}"
        elif path not in new:
            yield f"{path}: gone, was {json.dumps(old[path])}"
        elif type(old[path]) is not type(new[path]) or old[path] != new[path]:
            yield f"{path}: {json.dumps(old[path])} -> {json.dumps(new[path])}"


def _hash(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:_DIGITS]


def _show(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
