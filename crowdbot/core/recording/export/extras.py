"""Additional topics that ROS users expect, derived from a recording."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.container.chunk import Piece
from crowdbot.core.recording.export.arrival_pose import arrival_pose
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.ros_topics import ToolTopics
from crowdbot.core.recording.topics import Topic
from crowdbot.core.recording.viewers import RobotPath
from crowdbot.core.trajectories.tracks import RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories

#: Topics per sample, recorded less often unless everything is recorded.
OFTEN = (Topic.TF, Topic.PEOPLE_MARKER)


class Extra(NamedTuple):
    """A message that is not in the recording, as CDR."""

    topic: str
    ns: int
    msgtype: str
    data: bytes
    latched: bool = False


def extras(
    header: RecordingHeader, run: Trajectories, description: str | None, *, markers: bool
) -> Iterator[Extra]:
    """Yield messages to add to a bag, in order of time per topic.

    Clock, frames, poses, people, walls and map are as in a complete recording.

    Args:
        description: the robot's URDF, if it is known.
        markers: True to add a marker per person and contact.
    """
    for extra in _tools(header, run, description or ""):
        if markers or extra.topic != Topic.PEOPLE_MARKERS:
            yield extra
    if run.robot is not None:
        path = _path(run, run.robot)
        yield _extra(Topic.PATH, 0, path.path(0), latched=True)
        if markers:
            yield from _contacts(run, path)


def arrival(header: RecordingHeader, run: Trajectories) -> Iterator[Extra]:
    """Yield pose and frame of the robot at its arrival, if that is later than the last sample.

    A run ends between two samples, so no sample may lie in the goal.
    """
    robot = run.robot
    if robot is None or robot.goal_time is None or robot.goal_time <= run.t[-1]:
        return
    kept, ns = _Kept(), ros.nanoseconds(robot.goal_time)
    ToolTopics(kept, header, "").state(ns, arrival_pose(run, robot, robot.goal_time), None)
    for extra in kept.messages:
        if extra.ns == ns and extra.topic.endswith((Topic.POSE, Topic.TF)):
            yield extra


class _Kept:
    """A `ToolFile` that collects messages in memory."""

    def __init__(self) -> None:
        self.messages: list[Extra] = []

    def put(self, topic: str, ns: int, message: Any, *, latched: bool = False) -> None:
        """Collect one message, at ``ns`` nanoseconds."""
        self.put_bytes(topic, ns, message.__msgtype__, ros.to_cdr(message), latched=latched)

    def put_bytes(
        self, topic: str, ns: int, msgtype: str, *pieces: Piece, latched: bool = False
    ) -> None:
        """Collect one serialised message, at ``ns`` nanoseconds."""
        self.messages.append(Extra(str(topic), ns, msgtype, b"".join(pieces), latched))


def _tools(header: RecordingHeader, run: Trajectories, description: str) -> list[Extra]:
    """Return messages derived from header and samples."""
    kept = _Kept()
    tools = ToolTopics(kept, header, description)
    robot, people = run.robot, run.agents
    for k, t in enumerate(run.t.tolist()):
        pose = state = None
        if robot is not None:
            pose = float(robot.x[k]), float(robot.y[k]), float(robot.theta[k])
        if people is not None:
            state = np.stack([people.x[k], people.y[k], people.vx[k], people.vy[k]])
        tools.state(ros.nanoseconds(t), pose, state)
    return kept.messages


def _extra(topic: Topic, ns: int, message: Any, *, latched: bool = False) -> Extra:
    return Extra(str(topic), ns, message.__msgtype__, ros.to_cdr(message), latched)


def _path(run: Trajectories, robot: RobotTrack) -> RobotPath:
    path = RobotPath(robot.radius)
    for row in zip(run.t, robot.x, robot.y, robot.theta, strict=True):
        path.add(*map(float, row))
    return path


def _contacts(run: Trajectories, path: RobotPath) -> Iterator[Extra]:
    """Return a ball where each contact began, from its beginning on."""
    events = run.contacts
    if events is None:
        return
    for i in np.argsort(events.t0, kind="stable").tolist():
        t = float(events.t0[i])
        touch = path.touch(t, int(events.agent[i]), float(events.bearing[i]))
        yield _extra(Topic.CONTACT_MARKERS, ros.nanoseconds(t), touch)
