"""People in the messages of a topic: lists, arrays of numbers, markers."""

from __future__ import annotations

import math
from collections.abc import Container, Iterator, Sequence
from pathlib import Path
from typing import Any

from crowdbot.core.trajectories.bag.columns import BodyRow
from crowdbot.core.trajectories.bag.fields import header_of, linear_of, place_of
from crowdbot.core.trajectories.bag.markers import DELETED, is_marker, shapes
from crowdbot.core.trajectories.table_columns.robots import is_robot
from crowdbot.errors import InputError

#: Fields that may hold the list of people, in the order they are tried.
_LISTS = (
    "people", "persons", "tracks", "pedestrians", "agents", "agent_states", "objects",
    "detections", "markers", "poses",
)  # fmt: skip
_TABLE = ("id", "x", "y")
#: Fields that may name a person, in the order they are tried.
NAMES = (
    "track_id", "id", "tracking_id", "object_id", "person_id", "human_id", "agent_id",
    "pedestrian_id", "ped_id", "uuid", "name", "identifier", "label",
)  # fmt: skip
#: Package -> what the field ``type`` of its agents means.
_TYPES = {"hunav_msgs": {2: "robot", 3: "other"}, "pedsim_msgs": {2: "robot"}}
#: derived_object_msgs: what the field ``classification`` means; 0 to 3 are unknown.
_PEDESTRIAN = 4
_CLASSES = {
    5: "bike", 6: "car", 7: "truck", 8: "motorcycle", 9: "other vehicle", 10: "barrier",
    11: "sign",
}  # fmt: skip


def people_in(path: Path, topic: str, message: Any, log: int, number: int) -> list[BodyRow]:
    """Return the people of one message.

    Args:
        path, topic: names for messages.
        message: decoded.
        log: when it was recorded, ns.
        number: of the message in its topic.

    Raises:
        InputError: it has no list of people, or one without a position.
    """
    found = list(_rows(path, topic, message, log, number))
    for row in found:
        if row.role != DELETED and any(map(is_robot, row.labels.values())):
            row.role = "robot"
    return found


def may_list_people(fields: Container[str]) -> bool:
    """Return True if messages with such fields may list people."""
    return any(name in fields for name in _LISTS) or all(n in fields for n in _TABLE)


def lists_people(message: Any) -> bool | None:
    """Return True if a message lists bodies with positions; None if its list is empty.

    Lists of bare poses and of markers with the shape of a body count, as in `people_in`.
    """
    if _is_table(message):
        return True if len(message.x) else None
    items = _items(message)
    if items is None or not len(items):
        return None
    if all(is_marker(item) for item in items):
        bodies = (row for row in shapes(items, 0, 0) if row.role != DELETED)
        return True if any(bodies) else None
    return all(place_of(item) is not None for item in items)


def _items(message: Any) -> Sequence[Any] | None:
    if is_marker(message):
        return [message]
    if hasattr(message, "person"):
        return [message.person]
    named = next((getattr(message, n) for n in _LISTS if hasattr(message, n)), None)
    return _only_list(message) if named is None else named


def _only_list(message: Any) -> Sequence[Any] | None:
    """Return the list of bodies in a message with unknown field names; None if none or several.

    Lists are recognised by their items, which have positions; a message may have other lists, of
    texts.
    """
    fields = getattr(message, "__dataclass_fields__", {})
    values = [getattr(message, name) for name in fields]
    lists = [value for value in values if isinstance(value, list)]
    bodies = [found for found in lists if any(place_of(item) is not None for item in found)]
    if len(bodies) == 1:
        return bodies[0]
    empty = [found for found in lists if not found]
    return empty[0] if not bodies and empty else None


def _rows(path: Path, topic: str, message: Any, log: int, number: int) -> Iterator[BodyRow]:
    stamp, frame = header_of(message)
    if _is_table(message):
        yield from _of_table(message, log, number)
        return
    items = _items(message)
    if items is None:
        fields = [n for n in getattr(message, "__dataclass_fields__", {}) if n != "__msgtype__"]
        raise InputError(
            f"{path}: {topic} holds {message.__msgtype__}, which has no list of people: one field "
            "with a list of things that have a place; it has "
            f"{', '.join(fields) or 'none'}"
        )
    if all(is_marker(item) for item in items):
        yield from shapes(items, log, number)
        return
    for item in items:
        place = place_of(item)
        if place is None:
            raise InputError(
                f"{path}: {topic} holds {message.__msgtype__}, whose items have no position"
            )
        own_stamp, own_frame = header_of(item)
        yield BodyRow(
            log, stamp or own_stamp, number, frame or own_frame, place.xyz, _values(item),
            _labels(item), role=_role(item),
        )  # fmt: skip


def _is_table(message: Any) -> bool:
    """Return True for arrays with one number per person, as crowdbot writes them."""
    return all(hasattr(getattr(message, n, None), "__len__") for n in _TABLE)


def _of_table(message: Any, log: int, number: int) -> Iterator[BodyRow]:
    stamp, frame = header_of(message)
    names = [n for n in ("vx", "vy", "radius") if len(getattr(message, n, ())) == len(message.x)]
    for i, label in enumerate(message.id):
        xyz = float(message.x[i]), float(message.y[i]), 0.0
        values = {name: float(getattr(message, name)[i]) for name in names}
        yield BodyRow(log, stamp, number, frame, xyz, values, {"id": str(label)}, "table")


def _values(item: Any) -> dict[str, float]:
    values: dict[str, float] = {}
    linear = linear_of(item)
    plain = [getattr(item, name, None) for name in ("vx", "vy")]
    if linear is not None:
        values = {"vx": float(linear.x), "vy": float(linear.y)}
    elif all(isinstance(v, int | float) for v in plain):
        values = {"vx": float(item.vx), "vy": float(item.vy)}
    radius = getattr(item, "radius", None)
    if isinstance(radius, int | float) and math.isfinite(radius) and radius > 0.0:
        values["radius"] = float(radius)
    return values


def _labels(item: Any) -> dict[str, str]:
    return {name: _text(getattr(item, name)) for name in NAMES if hasattr(item, name)}


def _text(label: Any) -> str:
    uuid = getattr(label, "uuid", None)
    return bytes(uuid).hex() if uuid is not None else str(label).strip()


def _role(item: Any) -> str:
    package = str(getattr(item, "__msgtype__", "")).partition("/")[0]
    if package == "derived_object_msgs":
        kind = int(item.classification)
        return "person" if kind == _PEDESTRIAN else _CLASSES.get(kind, "unknown")
    return _TYPES.get(package, {}).get(getattr(item, "type", None) or 0, "person")
