"""Tables of a robot and of people from topics of a ROS 1 or ROS 2 bag."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.trajectories.bag.identities as identities
from crowdbot.core.trajectories.bag.clocks import (
    common_clock,
    filled,
    longest_part,
    tell_disorder,
)
from crowdbot.core.trajectories.bag.columns import BodyRow, Columns, columns_of
from crowdbot.core.trajectories.bag.frames import TF, TF_STATIC, Edge, FrameTree, edges_of
from crowdbot.core.trajectories.bag.into_one_frame import into_one_frame
from crowdbot.core.trajectories.bag.markers import without_deleted, without_parts
from crowdbot.core.trajectories.bag.people import lists_people, may_list_people, people_in
from crowdbot.core.trajectories.bag.reader import index_hint, messages, topic_fields
from crowdbot.core.trajectories.bag.robot import (
    base_frame,
    from_tree,
    pose_of,
    split_name,
    velocities,
    world_frame,
)
from crowdbot.core.trajectories.raw_table import Cells, RawTable
from crowdbot.errors import InputError


class BagTables(NamedTuple):
    """The tables of two topics, and notes on data that were changed or left out."""

    robot: RawTable | None
    people: RawTable | None
    notes: list[str]


def bag_tables(
    path: Path, robot: str | None, people: str | None, *, same_frame: bool = False
) -> BagTables:
    """Return the tables of two topics; times are from the headers, else from the recording.

    Args:
        path: a bag of ROS 1 (``.bag``), a folder of rosbag2, or its ``.mcap`` or ``.db3`` file.
        robot: topic with the pose: ``Odometry``, ``PoseStamped``, ``Pose`` and similar; or ``/tf``,
            ``/tf:FRAME``.
        people: topic with a list of people, or a ``PoseArray``.
        same_frame: True to treat frames of different names as the same.

    Raises:
        InputError: it cannot be read, a message has no pose or no list, or frames differ.
        UnknownNameError: there is no such topic.
    """
    if robot is None and people is None:
        raise InputError(f"{path}: which topics? Give robot=TOPIC, people=TOPIC or both")
    return _Reading(path, robot, people, same_frame).tables()


def people_topics(path: Path) -> list[str]:
    """Return the topics of a bag whose messages list people with positions, in order.

    Raises:
        InputError: it cannot be read.
    """
    found: dict[str, bool] = {}
    topics = {topic for topic, fields in topic_fields(path).items() if may_list_people(fields)}
    for topic, _, message in messages(path, topics) if topics else ():
        shown = lists_people(message)
        if shown is not None:  # an empty list shows nothing
            found[topic] = found.get(topic, True) and shown
    return sorted(topic for topic, people in found.items() if people)


class _Reading:
    """Reads one bag, from its messages to tables."""

    def __init__(self, path: Path, robot: str | None, people: str | None, same_frame: bool) -> None:
        self._path, self._people, self._same_frame = path, people, same_frame
        self._robot, self._base = split_name(robot)
        self._from_tf = self._robot == TF
        self._notes: list[str] = []
        self._seen: dict[str, list[BodyRow]] = {}
        self._edges: list[Edge] | None = None

    def tables(self) -> BagTables:
        """Return the tables."""
        topics = self._columns()
        by_stamp = self._by_stamp(topics)
        robot = topics.get(self._robot or "")
        people = topics.get(self._people or "")
        names = self._names(people)
        if people is not None:
            there = identities.not_at_origin(self._rows(people), names, self._notes)
            people = people.only(there)
        tree = FrameTree(self._transforms(topics), by_stamp=by_stamp)
        if self._from_tf:
            robot = self._robot_of_tree(tree, people)
        elif robot is not None:
            robot = self._finite(robot)
        robot, people = into_one_frame(
            self._path, tree, robot, people, self._notes, same_frame=self._same_frame
        )
        return BagTables(
            None if robot is None else self._robot_table(robot),
            None if people is None else self._people_table(people, robot),
            self._notes,
        )

    # ------------------------------------------------------------------------ messages
    def _columns(self) -> dict[str, Columns]:
        """Return the rows of the topics, without those of other parts of a bag with resets."""
        readers: dict[str, Callable[..., list[BodyRow]]] = {}
        if self._people is not None:
            readers[self._people] = people_in
        if self._robot is not None and not self._from_tf:
            readers[self._robot] = _pose
        count = dict.fromkeys(readers, 0)
        for topic, log, message in messages(self._path, set(readers)) if readers else ():
            rows = readers[topic](self._path, topic, message, log, count[topic])
            count[topic] += 1
            self._seen.setdefault(topic, []).extend(rows)
        for topic, number in count.items():
            if not number:
                raise InputError(f"{self._path}: {topic} has no messages{index_hint(self._path)}")
        if self._people is not None:
            self._seen[self._people] = self._persons(self._people)
        topics = {topic: columns_of(self._seen[topic]) for topic in readers}
        topics = {t: replace(c, stamp=filled(c.stamp, c.log)) for t, c in topics.items()}
        return longest_part(self._path, topics, self._notes)

    def _persons(self, topic: str) -> list[BodyRow]:
        rows = without_deleted(self._seen.get(topic, []), self._notes)
        rows = identities.persons_only(rows, self._notes)
        is_shape = bool(rows) and rows[0].group not in ("", "table")
        rows = without_parts(rows) if is_shape else rows
        if not rows:
            notes = f" ({'; '.join(self._notes)})" if self._notes else ""
            raise InputError(f"{self._path}: {topic} contains no people{notes}")
        return rows

    def _rows(self, people: Columns) -> list[BodyRow]:
        rows = self._seen[self._people or ""]
        return [rows[i] for i in people.row]

    def _by_stamp(self, topics: dict[str, Columns]) -> bool:
        """Return True if stamps are used; else replace them by times of recording in the topics."""
        if len(topics) == 2:
            both = [topics[name] for name in (self._robot, self._people) if name is not None]
            by_stamp = common_clock(both[0], both[1], self._notes)
        else:
            by_stamp = any(columns.stamp.any() for columns in topics.values()) or self._from_tf
        for name, columns in topics.items():
            if not by_stamp or not columns.stamp.any():
                topics[name] = replace(columns, stamp=columns.log)
        tell_disorder(topics, self._notes)
        return by_stamp

    def _names(self, people: Columns | None) -> list[str]:
        """Return the name of each person's row; without names, its place in the list."""
        if people is None:
            return []
        rows = self._rows(people)
        field = identities.label_field(rows)
        return identities.places(rows) if field is None else identities.named(rows, field)

    # ---------------------------------------------------------------------- transforms
    def _transforms(self, topics: dict[str, Columns]) -> list[Edge]:
        """Return the bag's transforms, including those of odometry, if they are needed."""
        frames = {frame for columns in topics.values() for frame in columns.frame} - {""}
        alone = self._robot is None and frames <= {"map", "world", "odom"}
        same = self._same_frame or (self._robot is not None and len(frames) <= 1)
        if not self._from_tf and (same or alone):
            return []
        present = {TF, TF_STATIC} & set(topic_fields(self._path))
        if self._from_tf and TF not in present:
            present.add(TF)  # refused with the topics that there are
        edges = [
            edge
            for topic, log, message in (messages(self._path, present) if present else ())
            for edge in edges_of(message, log, topic)
        ]
        span = [(c.log.min(), c.log.max()) for c in topics.values() if len(c)]
        if span:
            first, last = min(s[0] for s in span) - 10**9, max(s[1] for s in span) + 10**9
            edges = [e for e in edges if e.is_static or first <= e.log <= last]
        return edges + self._odometry(topics, {edge.child for edge in edges})

    def _odometry(self, topics: dict[str, Columns], known: set[str]) -> list[Edge]:
        robot = topics.get(self._robot or "")
        if robot is None or "theta" not in robot.values:
            return []
        rows = self._seen[self._robot or ""]
        return [
            Edge(log, stamp, frame, child, (xyz[0], xyz[1], xyz[2]),
                 (0.0, 0.0, float(np.sin(theta / 2)), float(np.cos(theta / 2))), False)
            for log, stamp, frame, child, xyz, theta in zip(
                robot.log.tolist(), robot.stamp.tolist(), robot.frame.tolist(),
                [rows[i].labels["child"] for i in robot.row], robot.xyz.tolist(),
                robot.values["theta"].tolist(), strict=True,
            )
            if child and child not in known and np.isfinite(theta)
        ]  # fmt: skip

    def _robot_of_tree(self, tree: FrameTree, people: Columns | None) -> Columns:
        base = base_frame(self._path, tree, self._base or "")
        of_people = [] if people is None else list(dict.fromkeys(people.frame.tolist()))
        world = world_frame(tree, base, of_people)
        if not world:
            raise InputError(f"{self._path}: {TF} has no transform to frame '{base}'")
        robot = from_tree(tree, base, world)
        self._notes += tree.cut_short(base, world)
        return robot

    # -------------------------------------------------------------------------- tables
    def _finite(self, robot: Columns) -> Columns:
        """Return the robot's rows with finite poses."""
        finite = np.asarray(np.isfinite(robot.xyz[:, :2]).all(axis=1))
        if not finite.any():
            raise InputError(f"{self._path}: no position of the robot is finite")
        if lost := np.count_nonzero(~finite):
            self._notes.append(f"{lost} positions of the robot that are not finite are left out")
        return robot.only(finite)

    def _robot_table(self, robot: Columns) -> RawTable:
        order = np.argsort(robot.stamp, kind="stable")
        order = order[np.diff(robot.stamp[order], append=np.iinfo(np.int64).max) > 0]
        robot = robot.only(order)
        return self._table(self._robot, robot, {"x": robot.xyz[:, 0], "y": robot.xyz[:, 1]})

    def _people_table(self, people: Columns, robot: Columns | None) -> RawTable:
        rows, times = self._rows(people), people.stamp / 1e9
        field = identities.label_field(rows)
        if field is None:
            at = [replace(r, xyz=tuple(p)) for r, p in zip(rows, people.xyz.tolist(), strict=True)]
            names = np.array(identities.linked(at, times, self._notes))
        else:
            names = np.array(identities.named(rows, field))
        left = identities.not_the_robot(people, names, robot, self._notes)
        once = {
            (t, n): i for i, (t, n) in enumerate(zip(people.stamp, names, strict=True)) if left[i]
        }
        chosen = np.array(sorted(once.values()), np.int64)  # a repeated message adds nothing
        if not len(chosen):
            notes = "; ".join(self._notes)
            raise InputError(f"{self._path}: {self._people} contains no people ({notes})")
        chosen = chosen[np.argsort(people.stamp[chosen], kind="stable")]
        people, names = people.only(chosen), names[chosen]
        return self._table(
            self._people, people,
            {"id": names.tolist(), "x": people.xyz[:, 0], "y": people.xyz[:, 1]},
        )  # fmt: skip

    def _table(self, topic: str | None, columns: Columns, own: dict[str, Any]) -> RawTable:
        times: NDArray[Any] = columns.stamp.astype("datetime64[ns]")
        cells: dict[str, Cells] = {"t": times, **own, **self._values(columns)}
        return RawTable(f"{self._path}: {topic}", cells)

    def _values(self, columns: Columns) -> dict[str, Any]:
        values = dict(columns.values)
        velocity = [name for name in ("v", "vx", "vy", "w") if name in values]
        if not any(np.nan_to_num(values[name]).any() for name in velocity):
            for name in velocity:  # not filled in, or no one moves
                del values[name]
        if "v" in values or "theta" in values:
            return velocities(replace(columns, values=values))
        return values


def _pose(path: Path, topic: str, message: Any, log: int, number: int) -> list[BodyRow]:
    return [pose_of(path, topic, message, log, number)]
