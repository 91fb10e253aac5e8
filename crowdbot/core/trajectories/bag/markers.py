"""People shown as markers for viewers: one shape each, or points of a list."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from crowdbot.core.trajectories.bag.columns import BodyRow
from crowdbot.core.trajectories.bag.fields import header_of

#: visualization_msgs/Marker: kinds of markers and their actions.
_ARROW, _CUBE, _SPHERE, _CYLINDER, _MESH = 0, 1, 2, 3, 10
_CUBES, _SPHERES, _POINTS = 6, 7, 8
_ADD, _DELETE, _DELETE_ALL = 0, 2, 3
#: Role of a row that says that a marker is deleted, or all if it has no label.
DELETED = "deleted"
#: Label of a marker that viewers show until it is deleted, and of one that they drop by themselves.
_STAYS = "has no lifetime"
#: A marker that was last sent this long before the end is told, s.
_LONG_GONE = 1.0
#: Shapes that stand for bodies, the likeliest first. Lines and texts belong to a body beside them.
_RANK = {k: i for i, k in enumerate(
    (_CYLINDER, _MESH, _CUBE, _SPHERE, _SPHERES, _CUBES, _ARROW, _POINTS)
)}  # fmt: skip
_LISTS = (_CUBES, _SPHERES, _POINTS)
#: A wider shape does not stand for a person, m.
_WIDEST = 2.0
#: Shapes nearer than this in a message, nearly always, are parts of one body, m.
_SAME_PLACE, _NEARLY_ALWAYS = 0.1, 0.9


def is_marker(item: Any) -> bool:
    """Return True if an item is a marker."""
    return hasattr(item, "action") and hasattr(item, "ns") and hasattr(item, "scale")


def shapes(markers: Sequence[Any], log: int, message: int) -> Iterator[BodyRow]:
    """Yield the bodies that the markers of a message show, and the markers that it deletes."""
    for marker in markers:
        kind = int(marker.type)
        if int(marker.action) in (_DELETE, _DELETE_ALL):
            alone = int(marker.action) == _DELETE
            labels = {"ns and id": f"{marker.ns}/{marker.id}"} if alone else {}
            yield BodyRow(log, 0, message, "", (0.0, 0.0, 0.0), {}, labels, role=DELETED)
        if int(marker.action) != _ADD or kind not in _RANK:
            continue
        if kind in (_CUBE, _SPHERE, _CYLINDER) and max(marker.scale.x, marker.scale.y) > _WIDEST:
            continue
        stamp, frame = header_of(marker)
        group, number = f"{_RANK[kind]} {marker.ns}", f"{marker.ns}/{marker.id}"
        if kind in _LISTS:
            for xyz in _points(marker):
                yield BodyRow(log, stamp, message, frame, xyz, {}, {}, group)
            continue
        at = marker.points[0] if kind == _ARROW and len(marker.points) else marker.pose.position
        labels = {"id": str(marker.id), "ns and id": number}
        if not (marker.lifetime.sec or marker.lifetime.nanosec):
            labels[_STAYS] = "yes"
        yield BodyRow(log, stamp, message, frame, (at.x, at.y, at.z), {}, labels, group)


def without_deleted(rows: Sequence[BodyRow], notes: list[str]) -> list[BodyRow]:
    """Return rows of bodies; a note names markers that stop being sent without being deleted."""
    last = {row.labels["ns and id"]: row for row in rows if _STAYS in row.labels}
    end = max((row.log for row in rows), default=0)
    gone = {row.labels.get("ns and id", ""): row.message for row in rows if row.role == DELETED}
    kept = [
        name
        for name, row in last.items()
        if end - row.log > _LONG_GONE * 1e9
        and row.message >= max(gone.get(name, -1), gone.get("", -1))
    ]
    if kept:
        few = ", ".join(f"'{name}'" for name in kept[:3])
        notes.append(
            f"{len(kept)} marker(s), {few}, are not sent to the end and not deleted: viewers go on "
            "showing them; here no one is there after the last message"
        )
    return [row for row in rows if row.role != DELETED]


def _points(marker: Any) -> Iterator[tuple[float, float, float]]:
    """Yield the points of a marker's list; they lie in the frame of the marker's pose."""
    from scipy.spatial.transform import Rotation

    q, at = marker.pose.orientation, marker.pose.position
    points = np.array([(p.x, p.y, p.z) for p in marker.points]).reshape(-1, 3)
    if len(points) and q.x**2 + q.y**2 + q.z**2 + q.w**2 > 0.5:
        points = Rotation.from_quat((q.x, q.y, q.z, q.w)).apply(points)
    for x, y, z in points.tolist():
        yield x + at.x, y + at.y, z + at.z


def without_parts(rows: Sequence[BodyRow]) -> list[BodyRow]:
    """Return rows without shapes that are parts of other bodies, such as a head above a cylinder.

    Shapes with one namespace and type are left out if they nearly always coincide with shapes of a
    likelier type; arrows and points are left out if there is any other shape.
    """
    by_group: dict[str, dict[int, list[BodyRow]]] = {}
    for row in rows:
        by_group.setdefault(row.group, {}).setdefault(row.message, []).append(row)
    kept: list[dict[int, list[BodyRow]]] = []
    ranks: set[int] = set()
    for group in sorted(by_group):
        rank = int(group.partition(" ")[0])
        hint = rank >= _RANK[_ARROW] and any(r < rank for r in ranks)
        if not hint and not any(_stands_on(by_group[group], other) for other in kept):
            kept.append(by_group[group])
            ranks.add(rank)
    left = {id(row) for group in kept for found in group.values() for row in found}
    return [row for row in rows if id(row) in left]


def _stands_on(group: dict[int, list[BodyRow]], other: dict[int, list[BodyRow]]) -> bool:
    near = total = 0
    for message, rows in group.items():
        places = np.array([row.xyz[:2] for row in other.get(message, [])]).reshape(-1, 2)
        total += len(rows)
        for row in rows:
            gaps = np.hypot(*(places - row.xyz[:2]).T)
            near += bool(len(gaps)) and bool(gaps.min() < _SAME_PLACE)
    return near >= _NEARLY_ALWAYS * total
