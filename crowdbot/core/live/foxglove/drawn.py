"""Drawings of the planners of a finished run, as the messages of a live run."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from crowdbot.core.live.robot_topics import namespaces, robot_topic
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.drawings import drawn_marker, text_markers
from crowdbot.core.recording.placed_drawings import PlacedDrawing, placed_drawings
from crowdbot.core.recording.recording import Recording

#: Lines and texts of what a robot's planner draws.
THOUGHTS = "/thoughts_marker"
#: ns: older drawings are not shown after a jump.
_AGE = 500_000_000


class DrawnMessage(NamedTuple):
    """A message: topic, time (ns), name of the drawing, and ``visualization_msgs/Marker``."""

    topic: str
    ns: int
    name: str
    data: bytes


def drawn_messages(path: Path) -> list[DrawnMessage]:
    """Return all drawings of a recording in the order of time.

    Raises:
        InputError: the recording is damaged.
    """
    messages: list[DrawnMessage] = []
    with Recording(path) as opened:
        if not opened.holds_run:
            return []
        names = opened.robots
        spaces = namespaces(names)
        for name in names or (None,):
            drawings = opened.drawings(name)
            if drawings:
                topic = robot_topic(THOUGHTS, spaces[name] if name else "")
                for one in placed_drawings(opened.trajectories(name), drawings):
                    messages += _messages(topic, one)
    return sorted(messages, key=lambda one: one.ns)


def latest_drawn(drawn: Sequence[DrawnMessage], ns: int) -> Iterator[DrawnMessage]:
    """Yield the latest drawing of each topic and name at a time, without outdated ones."""
    begin = bisect_left(drawn, ns - _AGE, key=lambda one: one.ns)
    end = bisect_right(drawn, ns, key=lambda one: one.ns)
    recent = drawn[begin:end]
    latest = {(one.topic, one.name): one.ns for one in recent}
    yield from (one for one in recent if latest[one.topic, one.name] == one.ns)


def _messages(topic: str, one: PlacedDrawing) -> Iterator[DrawnMessage]:
    ns = ros.nanoseconds(one.t)
    shown = (
        [drawn_marker(ns, one.name, one.columns)]
        if one.texts is None
        else text_markers(ns, one.name, one.columns, one.texts)
    )
    for data in shown:
        yield DrawnMessage(topic, ns, one.name, data)
