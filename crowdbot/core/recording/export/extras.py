"""Topics that users of ROS expect and a recording leaves out: map, path, goal, people one each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from crowdbot.core.recording import messages as ros
from crowdbot.core.recording import scenery
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.people import HEADING_MIN_SPEED
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.trajectories import RobotTrack, Trajectories
from crowdbot.core.types.motion import Pose

#: People one by one are large: at most so many times a second, Hz.
_PEOPLE_RATE, _PATH_RATE = 4.0, 4.0
_PERSON, _TOUCH = (0.36, 0.55, 0.78, 1.0), (0.85, 0.2, 0.15, 0.9)
_TOUCH_SIZE = 0.25


class Extra(NamedTuple):
    """A message that is not in the recording."""

    topic: str
    ns: int
    message: Any
    latched: bool = False


def extras(
    header: RecordingHeader, run: Trajectories, description: str | None, *, markers: bool
) -> Iterator[Extra]:
    """What is added to a bag, in the order of time for each topic.

    Args:
        description: the robot's URDF, if it is known.
        markers: whether to add people and contacts as markers, one for each.
    """
    if header.walls is not None and len(header.walls):
        yield Extra(Topic.MAP, 0, scenery.occupancy_grid(0, header.walls), True)
    if description is not None:
        yield Extra("/robot_description", 0, ros.new("std_msgs/String", data=description), True)
    goal = scenery.goal_pose(0, header)
    if goal is not None:
        yield Extra(Topic.GOAL_POSE, 0, goal, True)
    if run.robot is not None:
        yield Extra("/robot/path", 0, _path(run, run.robot), True)
    if markers and run.agents is not None:
        yield from _people(run)
    if markers and run.contacts is not None and run.robot is not None:
        yield from _contacts(run, run.robot)


def _path(run: Trajectories, robot: RobotTrack) -> Any:
    """The whole way, a few poses a second."""
    chosen = _every(run.t, _PATH_RATE)
    rows = zip(run.t[chosen], robot.x[chosen], robot.y[chosen], robot.theta[chosen], strict=True)
    poses = [
        ros.pose_stamped(ros.nanoseconds(t), "map", Pose(x, y, yaw))
        for t, x, y, yaw in (map(float, row) for row in rows)
    ]
    return ros.new("nav_msgs/Path", header=ros.header(0, "map"), poses=poses)


def _every(t: Any, rate: float) -> list[int]:
    chosen, due = [], -math.inf
    for k, now in enumerate(t.tolist()):
        if now >= due - 1e-9:
            chosen.append(k)
            due = now + 1.0 / rate
    return chosen


def _people(run: Trajectories) -> Iterator[Extra]:
    """An arrow for each: where the person looks, as long as it is fast; the id is the person's."""
    people = run.agents
    assert people is not None
    heading = np.zeros(len(people.id))
    gone = ros.delete_all_markers()
    for k in _every(run.t, _PEOPLE_RATE):
        ns = ros.nanoseconds(float(run.t[k]))
        vx, vy = people.vx[k], people.vy[k]
        speed = np.hypot(vx, vy)
        with np.errstate(invalid="ignore"):
            moving = speed > HEADING_MIN_SPEED
        heading = np.where(moving, np.arctan2(vy, vx), heading)
        markers = [gone]
        for i in np.flatnonzero(np.isfinite(people.x[k])):
            x, y, yaw = float(people.x[k, i]), float(people.y[k, i]), float(heading[i])
            size = (max(float(speed[i]), 0.1), 2.0 * float(people.radius[i]), 0.1)
            head = ros.marker(ns, "people", "ARROW", size, _PERSON, np.zeros((0, 3)))
            head.id, head.pose = int(people.id[i]), ros.plane_pose(Pose(x, y, yaw))
            markers.append(head)
        yield Extra("/people_markers", ns, ros.marker_array(markers))


def _contacts(run: Trajectories, robot: RobotTrack) -> Iterator[Extra]:
    """A ball where each contact began, from its beginning on."""
    events = run.contacts
    assert events is not None
    order = np.argsort(events.t0, kind="stable")
    for number, i in enumerate(order.tolist()):
        t, side = float(events.t0[i]), float(events.bearing[i])
        x, y, yaw = (float(np.interp(t, run.t, c)) for c in (robot.x, robot.y, robot.theta))
        if math.isfinite(side):
            x += robot.radius * math.cos(yaw + side)
            y += robot.radius * math.sin(yaw + side)
        ns = ros.nanoseconds(t)
        size = (_TOUCH_SIZE,) * 3
        ball = ros.marker(ns, "contacts", "SPHERE", size, _TOUCH, np.zeros((0, 3)))
        ball.id, ball.pose = number, ros.plane_pose(Pose(x, y, 0.0))
        ball.text = f"person {int(events.agent[i])}" if events.agent[i] >= 0 else "wall"
        yield Extra("/contact_markers", ns, ros.marker_array([ball]))
