"""The planner's observations as messages of a ROS robot."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from crowdbot.core.live.message import LiveMessage, OfferedTopic, live_message
from crowdbot.core.planning.planner import Observation
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording import template
from crowdbot.core.recording.camera import CameraMessages
from crowdbot.core.recording.header import RecordingHeader, with_frames
from crowdbot.core.recording.namespace import in_namespace
from crowdbot.core.recording.scenery import BASE
from crowdbot.core.recording.topics import SensorTopic, Topic, is_odometry, sensor_topics
from crowdbot.core.sensing.depth_mm import depth_mm
from crowdbot.core.types.robot import DifferentialDrive, RobotModel
from crowdbot.core.types.sensor import CameraFrame, Reading, SensorInfo

OBSERVATION, JOINTS = "/crowdbot/observation", "/joint_states"
_ODOM = "/odom"
_JOINTS, _OBSERVED = "sensor_msgs/msg/JointState", "crowdbot_msgs/msg/Observation"
#: Readings with more numbers are images, which have their own topics.
_MOST_NUMBERS = 40_000
_LIDAR, _IMU = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu"


class Observed:
    """Builds the messages of one run's observations, for requested topics only.

    Sensors have the topics that they have in recordings. The first lidar also publishes ``/scan``,
    each lidar ``/scan/NAME``, and the first IMU ``/imu/data``.
    """

    def __init__(
        self,
        sensors: Mapping[str, SensorInfo],
        model: RobotModel,
        *,
        epoch: int = 0,
        namespace: str = "",
    ) -> None:
        """Prepare the messages.

        Args:
            epoch: ns added to all stamps.
            namespace: prefix of the frames.
        """
        sensors = with_frames(
            RecordingHeader(scenario="", sensors=sensors, namespace=namespace)
        ).sensors
        odom, base = (in_namespace(namespace, frame) for frame in ("odom", BASE))
        self._sensors, self._epoch = dict(sensors), epoch
        cameras = {n: i for n, i in sensors.items() if i.camera is not None}
        self._cameras = {n: CameraMessages(n, i) for n, i in cameras.items()}
        ranging = {n: i for n, i in sensors.items() if n not in cameras}
        self._topics = sensor_topics(ranging, namespace)
        self._names = {n: _names(n, t, self._topics) for n, t in self._topics.items()}
        self._wheels = _Wheels(model)
        self._odometry = any(is_odometry(i) for i in sensors.values())
        self._frame, self._tf = odom, template.transform(odom, base)
        self._odom, self._clock = template.odometry(base, odom), template.clock()
        self._shown: dict[str, float] = {}

    def offers(self) -> list[OfferedTopic]:
        """Return the topics, the clock last."""
        found = [
            OfferedTopic(n, t.msgtype) for s, t in self._topics.items() for n in self._names[s]
        ]
        for name, info in self._sensors.items():
            kinds = () if info.camera is None else ("depth", "color")[: 1 + info.camera.colour]
            for kind in kinds:
                found.append(OfferedTopic(f"/{name}/{kind}/image_raw", "sensor_msgs/msg/Image"))
                found.append(
                    OfferedTopic(f"/{name}/{kind}/camera_info", "sensor_msgs/msg/CameraInfo")
                )
        if not self._odometry:
            found.append(OfferedTopic(_ODOM, self._odom.msgtype))
        found.append(OfferedTopic(str(Topic.TF), self._tf.msgtype))
        found.append(OfferedTopic(JOINTS, _JOINTS))
        found.append(OfferedTopic(OBSERVATION, _OBSERVED))
        found.append(OfferedTopic(str(Topic.CLOCK), self._clock.msgtype))
        return found

    def messages(
        self, obs: Observation, subscribed: Callable[[str], bool]
    ) -> Iterator[LiveMessage]:
        """Yield new messages, the clock last.

        Args:
            obs: observation of one step.
            subscribed: function that returns True if a client listens to a topic.
        """
        self._wheels.turn(obs)
        for name, reading in obs.readings.items():
            if self._shown.get(name, -1.0) < reading.stamp:
                self._shown[name] = reading.stamp
                yield from self._reading(name, reading, subscribed)
        yield from self._state(obs, subscribed)

    def again(self, obs: Observation, subscribed: Callable[[str], bool]) -> Iterator[LiveMessage]:
        """Yield the latest messages again, for clients that connected after `messages`."""
        for name, reading in obs.readings.items():
            yield from self._reading(name, reading, subscribed)
        yield from self._state(obs, subscribed)

    def _state(self, obs: Observation, subscribed: Callable[[str], bool]) -> Iterator[LiveMessage]:
        ns = self._epoch + ros.nanoseconds(obs.t)
        if not self._odometry and subscribed(_ODOM):
            yield LiveMessage(_ODOM, self._odom.msgtype, ns, self._odometer(ns, obs))
        if subscribed(Topic.TF):
            parts = template.stamp(ns), template.two(*obs.pose[:2]), template.turn(obs.pose.yaw)
            yield LiveMessage(str(Topic.TF), self._tf.msgtype, ns, self._tf.fill(*parts))
        if subscribed(JOINTS):
            yield live_message(JOINTS, ns, self._wheels.message(ns))
        if subscribed(OBSERVATION):
            yield live_message(OBSERVATION, ns, _observation(ns, obs, self._frame))
        if subscribed(Topic.CLOCK):
            data = self._clock.fill(template.stamp(ns))
            yield LiveMessage(str(Topic.CLOCK), self._clock.msgtype, ns, data)

    def _reading(
        self, name: str, reading: Reading, subscribed: Callable[[str], bool]
    ) -> Iterator[LiveMessage]:
        ns = self._epoch + ros.nanoseconds(reading.stamp)
        if name in self._cameras:
            yield from self._images(name, reading, ns, subscribed)
            return
        topic = self._topics[name]
        names = [n for n in self._names[name] if subscribed(n)]
        if names or is_odometry(self._sensors[name]):  # whose covariance grows with each reading
            data = topic.message(ns, reading.values)
            for each in names:
                yield LiveMessage(each, topic.msgtype, ns, data)

    def _images(
        self, name: str, reading: Reading, ns: int, subscribed: Callable[[str], bool]
    ) -> Iterator[LiveMessage]:
        leaves = ("image_raw", "camera_info")
        kinds = ("depth", "color") if reading.colour is not None else ("depth",)
        if not any(subscribed(f"/{name}/{kind}/{leaf}") for kind in kinds for leaf in leaves):
            return
        frame = CameraFrame(ns / 1e9, depth_mm(reading.values), reading.colour)
        for image in self._cameras[name](frame):
            if subscribed(image.topic):
                yield LiveMessage(image.topic, image.msgtype, ns, b"".join(image.pieces))

    def _odometer(self, ns: int, obs: Observation) -> bytes:
        """Return odometry of a robot without an odometer, from its assumed pose and twist."""
        x, y, yaw = obs.pose
        speed, turn = template.two(obs.twist[0], obs.vy), template.one(obs.twist[1])
        pose_known, twist_known = template.NO_COVARIANCE
        return self._odom.fill(
            template.stamp(ns), template.two(x, y), template.turn(yaw), pose_known,
            speed, turn, twist_known,
        )  # fmt: skip


def _names(name: str, topic: SensorTopic, topics: Mapping[str, SensorTopic]) -> tuple[str, ...]:
    """Return the names under which a sensor's messages are sent."""
    first = {t.msgtype: n for n, t in reversed(list(topics.items()))}
    names = [topic.name]
    if topic.msgtype == _LIDAR:
        names.append(f"/scan/{name}")
        names += ["/scan"] if first[_LIDAR] == name else []
    elif topic.msgtype == _IMU and first[_IMU] == name:
        names.append("/imu/data")
    return tuple(dict.fromkeys(names))


class _Wheels:
    """Angles of the driven wheels, integrated from odometry's speeds."""

    def __init__(self, model: RobotModel) -> None:
        drive = model.drive
        self._drive = drive if isinstance(drive, DifferentialDrive) else None
        self._t = 0.0
        self._angles, self._rates = [0.0, 0.0], [0.0, 0.0]

    def turn(self, obs: Observation) -> None:
        """Advance to the time of an observation."""
        if self._drive is None:
            return
        v, w = obs.twist
        rim = 0.5 * self._drive.track * w
        self._rates = [x / self._drive.command_radius for x in (v - rim, v + rim)]
        since, self._t = obs.t - self._t, obs.t
        self._angles = [a + r * since for a, r in zip(self._angles, self._rates, strict=True)]

    def message(self, ns: int) -> Any:
        """Return a ``sensor_msgs/JointState``; without joints if there are no driven wheels."""
        drive = self._drive
        return ros.new(
            "sensor_msgs/JointState",
            header=ros.header(ns, ""),
            name=[] if drive is None else [drive.left_joint, drive.right_joint],
            position=np.array([] if drive is None else self._angles, np.float64),
            velocity=np.array([] if drive is None else self._rates, np.float64),
            effort=np.zeros(0),
        )


def _observation(ns: int, obs: Observation, frame: str) -> Any:
    """Return all numbers of an observation exactly; images have their own topics."""
    readings = [
        ros.new(
            "crowdbot_msgs/Reading",
            sensor=n,
            stamp=r.stamp,
            values=ros.table(np.atleast_1d(r.values)),
        )
        for n, r in obs.readings.items()
        if r.values.size <= _MOST_NUMBERS
    ]
    v, w = obs.twist
    return ros.new(
        "crowdbot_msgs/Observation",
        header=ros.header(ns, frame),
        t=obs.t,
        pose=np.array(obs.pose, np.float64),
        twist=np.array([v, w, obs.vy], np.float64),
        readings=readings,
    )
