"""Topics that users of ROS expect and that a recording may lack: map, path, goal, people."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from crowdbot.core.recording import messages as ros
from crowdbot.core.recording import scenery
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.scans import Thinning
from crowdbot.core.recording.topics import Topic
from crowdbot.core.recording.viewers import ARROWS_TYPE, PEOPLE_RATE, PeopleArrows, RobotWay
from crowdbot.core.trajectories.trajectories import RobotTrack, Trajectories


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
    """What may be added to a bag, in the order of time for each topic.

    Args:
        description: the robot's URDF, if it is known.
        markers: whether to add people and contacts as markers, one for each.
    """
    if header.walls is not None and len(header.walls):
        yield _told(Topic.MAP, 0, scenery.occupancy_grid(0, header.walls), latched=True)
    if description is not None:
        text = ros.new("std_msgs/String", data=description)
        yield _told(Topic.DESCRIPTION, 0, text, latched=True)
    goal = scenery.goal_pose(0, header)
    if goal is not None:
        yield _told(Topic.GOAL_POSE, 0, goal, latched=True)
    if run.robot is not None:
        way = _way(run, run.robot)
        yield _told(Topic.PATH, 0, way.path(0), latched=True)
        if markers:
            yield from _contacts(run, way)
    if markers and run.agents is not None:
        yield from _people(run)


def _told(topic: Topic, ns: int, message: Any, *, latched: bool = False) -> Extra:
    return Extra(str(topic), ns, message.__msgtype__, ros.to_cdr(message), latched)


def _way(run: Trajectories, robot: RobotTrack) -> RobotWay:
    way = RobotWay(robot.radius)
    for row in zip(run.t, robot.x, robot.y, robot.theta, strict=True):
        way.add(*map(float, row))
    return way


def _people(run: Trajectories) -> Iterator[Extra]:
    people = run.agents
    assert people is not None
    arrows, due = PeopleArrows(people.id, people.radius), Thinning(PEOPLE_RATE)
    for k, t in enumerate(run.t.tolist()):
        ns = ros.nanoseconds(t)
        if due.keeps(ns):
            state = np.stack([people.x[k], people.y[k], people.vx[k], people.vy[k]])
            yield Extra(str(Topic.PEOPLE_MARKERS), ns, ARROWS_TYPE, arrows.message(ns, state))


def _contacts(run: Trajectories, way: RobotWay) -> Iterator[Extra]:
    """A ball where each contact began, from its beginning on."""
    events = run.contacts
    if events is None:
        return
    for i in np.argsort(events.t0, kind="stable").tolist():
        t = float(events.t0[i])
        touch = way.touch(t, int(events.agent[i]), float(events.bearing[i]))
        yield _told(Topic.CONTACT_MARKERS, ros.nanoseconds(t), touch)
