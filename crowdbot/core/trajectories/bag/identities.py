"""Identities of people in the messages of a topic: names, places in a list, or nearness.

Rows that do not belong to a person are left out here: placeholders at the origin, robots, objects.
"""

from __future__ import annotations

from bisect import bisect
from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.bag.columns import BodyRow, Columns
from crowdbot.core.trajectories.bag.people import NAMES
from crowdbot.core.types.arrays import Array

#: No one is faster, m/s; and no position is surer, m.
_FASTEST, _SCATTER = 3.5, 0.4
#: After this time without a row a nameless person is another one, s.
_LOST = 1.0
#: A row at exactly the origin is a placeholder if its neighbours are further away, m.
_NEAR_ORIGIN = 0.5
#: A person all along nearer than this to the robot's centre is the robot, m.
_ITSELF = 0.15
_FIELDS = ("id", "ns and id", *NAMES)
_EVERYTHING_ELSE = "unknown"


def persons_only(rows: Sequence[BodyRow], notes: list[str]) -> list[BodyRow]:
    """Return rows of persons; a note counts other objects.

    Objects of unknown class are kept only if none is known to be a person.
    """
    roles = Counter(row.role for row in rows)
    kept_role = "person" if roles["person"] or not roles[_EVERYTHING_ELSE] else _EVERYTHING_ELSE
    others = sorted(role for role in roles if role != kept_role)
    if others:
        seen = ", ".join(f"{roles[role]} of kind '{role}'" for role in others)
        notes.append(f"rows of others than persons are left out: {seen}")
    if kept_role == _EVERYTHING_ELSE:
        notes.append("no object is classified; all of unknown kind are taken for persons")
    return [row for row in rows if row.role == kept_role]


def label_field(rows: Sequence[BodyRow]) -> str | None:
    """Return the field that identifies people: never empty, and unique within a message."""
    by_message: dict[int, list[BodyRow]] = {}
    for row in rows:
        by_message.setdefault(row.message, []).append(row)
    for field in dict.fromkeys(_FIELDS):
        if all(_distinct([row.labels.get(field, "") for row in m]) for m in by_message.values()):
            return field
    return None


def _distinct(labels: Sequence[str]) -> bool:
    return all(labels) and len(set(labels)) == len(labels)


def named(rows: Sequence[BodyRow], field: str) -> list[str]:
    """Return the name of each row."""
    return [row.labels[field] for row in rows]


def places(rows: Sequence[BodyRow]) -> list[str]:
    """Return each row's position in the list of its message."""
    count: Counter[int] = Counter()
    found = []
    for row in rows:
        found.append(str(count[row.message]))
        count[row.message] += 1
    return found


def linked(rows: Sequence[BodyRow], times: Array, notes: list[str]) -> list[str]:
    """Return identities of people in messages without any.

    The list position is the identity if the number of people never changes and no one moves faster
    than a person; otherwise the nearest prediction from the last message at constant velocity.

    Args:
        rows: in order of their messages.
        times: (K,) s.
        notes: takes a sentence in the second case.
    """
    messages = np.array([row.message for row in rows])
    starts = np.flatnonzero(np.diff(messages, prepend=-1))
    lists = np.split(np.arange(len(rows)), starts[1:])
    xy = np.array([row.xyz[:2] for row in rows])
    if _ordered(lists, xy, times):
        return [str(i) for found in lists for i in range(len(found))]
    numbers = _by_nearness(lists, xy, times)
    notes.append(
        f"messages do not say who is who; {numbers.max() + 1} people are told apart by nearness"
    )
    return [str(n) for n in numbers]


def _ordered(lists: Sequence[NDArray[np.int64]], xy: Array, times: Array) -> bool:
    if len({len(found) for found in lists}) > 1:
        return False
    places = xy[np.concatenate(lists)].reshape(len(lists), -1, 2)
    t = times[[found[0] for found in lists]]
    steps = np.hypot(*np.moveaxis(np.diff(places, axis=0), -1, 0))
    return bool(np.all(steps <= _reach(np.diff(t))[:, None]))


def _reach(dt: Array) -> Array:
    return np.asarray(_SCATTER + _FASTEST * np.maximum(dt, 0.0))


def _by_nearness(lists: Sequence[NDArray[np.int64]], xy: Array, times: Array) -> NDArray[np.int64]:
    """Return the person of each row, numbered as they appear."""
    from scipy.optimize import linear_sum_assignment

    numbers = np.full(len(xy), -1, np.int64)
    count = 0
    last: dict[int, tuple[float, Array, Array]] = {}  # person -> time, place, velocity
    for found in lists:
        t = float(times[found[0]])
        last = {n: known for n, known in last.items() if t - known[0] <= _LOST}
        people = list(last)
        if people:
            gone = np.array([t - last[n][0] for n in people])
            expected = np.array([last[n][1] + last[n][2] * (t - last[n][0]) for n in people])
            gaps = np.linalg.norm(xy[found][:, None] - expected[None], axis=2)
            far = gaps > _reach(gone)
            for i, j in zip(*linear_sum_assignment(np.where(far, 1e6, gaps)), strict=True):
                if not far[i, j]:
                    numbers[found[i]] = people[j]
        for row in found:
            if numbers[row] < 0:
                numbers[row], count = count, count + 1
            before = last.get(int(numbers[row]))
            velocity = np.zeros(2)
            if before is not None and t > before[0]:
                velocity = (xy[row] - before[1]) / (t - before[0])
            last[int(numbers[row])] = (t, xy[row], velocity)
    return numbers


def not_at_origin(
    rows: Sequence[BodyRow], names: Sequence[str], notes: list[str]
) -> NDArray[np.bool_]:
    """Return a mask of rows (K,) with a position: finite, and no placeholder at exactly (0, 0).

    Trackers fill unused entries of their lists with zeros. A row there counts if the person comes
    from nearby or goes there, and if it is the only one of its message.
    """
    xy = np.array([row.xyz[:2] for row in rows]).reshape(-1, 2)
    finite = np.asarray(np.isfinite(xy).all(axis=1))
    if not finite.all():
        notes.append(f"{np.count_nonzero(~finite)} positions that are not finite are left out")
    zero = np.asarray(np.all(xy == 0.0, axis=1))
    if not zero.any() or rows[0].group == "table":  # crowdbot's own has only people who are there
        return finite
    several = Counter(rows[i].message for i in np.flatnonzero(zero).tolist())
    tracks: dict[str, list[int]] = {}
    for i in np.flatnonzero(finite).tolist():
        tracks.setdefault(names[i], []).append(i)
    there = finite.copy()
    for track in tracks.values():
        for i in (i for i in track if zero[i]):
            there[i] = several[rows[i].message] == 1 and _is_passing(i, track, xy)
    left_out = np.count_nonzero(finite & ~there)
    if left_out:
        notes.append(f"{left_out} positions at exactly (0, 0) are left out: no one is there")
    return there


def _is_passing(row: int, track: Sequence[int], xy: Array) -> bool:
    """Return True if the nearest other places of a track, before or after, are near the origin."""
    known = [i for i in track if xy[i].any()]
    k = bisect(known, row)
    return any(np.hypot(*xy[known[j]]) < _NEAR_ORIGIN for j in (k - 1, k) if 0 <= j < len(known))


def not_the_robot(
    people: Columns, names: NDArray[Any], robot: Columns | None, notes: list[str]
) -> NDArray[np.bool_]:
    """Return a mask of people's rows (K,) that are not the robot, which some lists contain.

    A track is the robot if it has the robot's position all along.
    """
    left = np.ones(len(people), bool)
    if robot is None or not len(robot):
        return left
    order = np.argsort(robot.stamp, kind="stable")
    t, xy = robot.stamp[order], robot.xyz[order, :2]
    for name in dict.fromkeys(names.tolist()):
        mine = np.flatnonzero(names == name)
        during = mine[(people.stamp[mine] >= t[0]) & (people.stamp[mine] <= t[-1])]
        if not len(during):
            continue
        at = np.stack([np.interp(people.stamp[during], t, xy[:, i]) for i in (0, 1)], axis=1)
        gaps = np.hypot(*(people.xyz[during, :2] - at).T)
        if np.median(gaps) < _ITSELF and np.quantile(gaps, 0.9) < 2 * _ITSELF:
            left[mine] = False
            notes.append(f"'{name}' stands where the robot does, all along: it is the robot itself")
    return left
