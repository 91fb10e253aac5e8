"""Topics for ROS tools and 3-D viewers; scores do not use them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import crowdbot.core.recording.markers as markers
import crowdbot.core.recording.messages as ros
import crowdbot.core.recording.scenery as scenery
import crowdbot.core.recording.template as template
from crowdbot.core.recording.container.chunk import Piece
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.namespace import in_namespace
from crowdbot.core.recording.people import MARKER, PEOPLE, PeopleMessages
from crowdbot.core.recording.reading.scans import REPLAY_RATE, Thinning
from crowdbot.core.recording.template import Template
from crowdbot.core.recording.topics import Topic, is_odometry, usual_names
from crowdbot.core.recording.viewers import ARROWS_TYPE, PEOPLE_RATE, PeopleArrows, RobotPath
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command


class ToolFile(Protocol):
    """Protocol of a file that takes messages, such as a recording."""

    def put(self, topic: str, ns: int, message: Any, *, latched: bool = False) -> None:
        """Take a message, logged at ``ns`` nanoseconds of simulated time."""

    def put_bytes(
        self, topic: str, ns: int, msgtype: str, *pieces: Piece, latched: bool = False
    ) -> None:
        """Take a serialised message, in one or more pieces."""


class ToolTopics:
    """Writes clock, frames, map, robot, commands, people, path and contacts to a file."""

    def __init__(
        self, file: ToolFile, header: RecordingHeader, description: str, *, whole: bool = True
    ) -> None:
        """Write the static messages.

        Args:
            file: file of the recording.
            header: constants of the run.
            description: the robot's URDF; may be empty.
            whole: False limits samples to a viewer's needs: the robot's pose at the rate of scans,
                and people's positions.
        """
        self._file, self._whole = file, whole
        agents, robot = header.agents, header.robot
        self._people = None if agents is None else PeopleMessages(agents)
        self._arrows = None if agents is None else PeopleArrows(agents.id, agents.radius)
        self._people_due, self._pose_due = Thinning(PEOPLE_RATE), Thinning(REPLAY_RATE)
        self._path_so_far = None if robot is None else RobotPath(robot.radius)
        self._clock, self._twist = template.clock(), template.twist()
        self._namespace = header.namespace
        base, odom = (in_namespace(self._namespace, f) for f in (scenery.BASE, "odom"))
        self._truth = template.transform("map", base)
        self._believed = template.transform(odom, base)
        self._pose = template.pose_stamped("map")
        self._usual = usual_names(header.sensors)
        self._odometry = next((n for n, s in header.sensors.items() if is_odometry(s)), None)
        self._scenery(header, description)

    def state(self, ns: int, robot: Sequence[float] | None, agents: Array | None) -> None:
        """Write one sample: x, y, yaw of the robot; people (4, M); either may be missing."""
        if self._whole and not self._namespace:
            self._put(Topic.CLOCK, ns, self._clock, template.stamp(ns))
        if robot is not None:
            self._robot(ns, *robot[:3])
        if agents is not None:
            self._crowd(ns, agents)

    def _robot(self, ns: int, x: float, y: float, yaw: float) -> None:
        parts = template.stamp(ns), template.two(x, y), template.turn(yaw)
        if self._whole or self._pose_due.keeps(ns):
            self._put(Topic.TF, ns, self._truth, *parts)
        if self._whole:
            self._put(Topic.POSE, ns, self._pose, *parts)
        if self._path_so_far is not None:
            self._path_so_far.add(ns / 1e9, x, y, yaw)

    def _crowd(self, ns: int, agents: Array) -> None:
        if self._people is None or self._arrows is None:
            return
        seldom = self._people_due.keeps(ns)
        if self._whole:
            people = self._people.pedestrians(ns, agents)
            self._file.put_bytes(Topic.PEOPLE, ns, PEOPLE, people)
        if self._whole or seldom:
            data = self._people.marker(ns, agents)
            self._file.put_bytes(Topic.PEOPLE_MARKER, ns, MARKER, data)
        if self._whole and seldom:
            data = self._arrows.message(ns, agents)
            self._file.put_bytes(Topic.PEOPLE_MARKERS, ns, ARROWS_TYPE, data)

    def measured(self, sensor: str, ns: int, msgtype: str, data: bytes, values: Array) -> None:
        """Write a reading again under its usual ROS name, and the frame of odometry."""
        usual = self._usual.get(sensor)
        if usual is not None:
            self._file.put_bytes(usual, ns, msgtype, data)
        if sensor == self._odometry:
            x, y, yaw = values[:3].tolist()
            parts = template.stamp(ns), template.two(x, y), template.turn(yaw)
            self._put(Topic.TF_ODOMETRY, ns, self._believed, *parts)

    def command(self, ns: int, command: Command) -> None:
        """Write the planner's command."""
        parts = template.two(command.v, command.vy), template.one(command.w)
        self._put(Topic.COMMAND, ns, self._twist, *parts)

    def contact(self, t0: float, ns: int, agent: int, bearing: float) -> None:
        """Write a contact that began at ``t0`` (s) and ended at ``ns``."""
        if self._path_so_far is not None:
            touch = self._path_so_far.touch(t0, agent, bearing)
            self._file.put(Topic.CONTACT_MARKERS, ns, touch)

    def path(self, ns: int) -> None:
        """Write the path so far."""
        if self._path_so_far is not None and self._path_so_far.known:
            self._file.put(Topic.PATH, ns, self._path_so_far.path(ns))

    def _scenery(self, header: RecordingHeader, description: str) -> None:
        frames = scenery.static_frames(header, description)
        if frames:
            self._file.put(Topic.TF_STATIC, 0, ros.transforms(frames), latched=True)
        if description:
            text = ros.new("std_msgs/String", data=description)
            self._file.put(Topic.DESCRIPTION, 0, text, latched=True)
        walls, zone = header.walls, header.goal_zone
        if walls is not None and len(walls) and not self._namespace:
            self._file.put(Topic.WALLS, 0, scenery.wall_lines(walls), latched=True)
            goal = None if header.robot is None else header.robot.goal
            grid = scenery.occupancy_grid(0, walls, goal=goal)
            self._file.put(Topic.MAP, 0, grid, latched=True)
        if zone is not None and len(zone):
            self._file.put(Topic.GOAL, 0, markers.polygon(0, zone), latched=True)
        pose = scenery.goal_pose(0, header)
        if pose is not None:
            self._file.put(Topic.GOAL_POSE, 0, pose, latched=True)

    def _put(self, topic: Topic, ns: int, blank: Template, *parts: bytes) -> None:
        self._file.put_bytes(topic, ns, blank.msgtype, blank.fill(*parts))
