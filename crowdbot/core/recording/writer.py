"""RecordingWriter: streams one run to an MCAP file with ROS 2 messages.

The ``/crowdbot/...`` topics and ``/contacts`` carry the exact float64 numbers for scores; all
others are for the replay page and for ROS tools and are optional.

Data is buffered and converted to messages at the next `flush`, all in sequence, so that the code
stays in the processor's caches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial, wraps
from pathlib import Path
from typing import Concatenate, Literal, ParamSpec, cast

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.messages as ros
from crowdbot.core.planning.drawn import Drawn
from crowdbot.core.recording.camera import CameraMessages
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.container.own_file import Written
from crowdbot.core.recording.drawings import drawing_message
from crowdbot.core.recording.header import RecordingHeader, tilts_message, with_frames
from crowdbot.core.recording.joints import WheelMessages
from crowdbot.core.recording.motion.candidates import CandidateGroup
from crowdbot.core.recording.motion.states import SeriesRows, StateSample, StatesWriter
from crowdbot.core.recording.namespace import NamespacedFile, in_namespace
from crowdbot.core.recording.person_task import person_task_message
from crowdbot.core.recording.reading.images import REPLAY_IMAGE_RATE, REPLAY_IMAGE_WIDTH
from crowdbot.core.recording.reading.scans import REPLAY_RATE, Thinning, whole_centimetres
from crowdbot.core.recording.ros_topics import ToolTopics
from crowdbot.core.recording.template import trip, whole_trip
from crowdbot.core.recording.topics import (
    Topic,
    is_cone,
    is_scan,
    sensor_topics,
)
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command
from crowdbot.core.types.sensor import CameraFrame, Reading

#: Largest number of rows, or bytes of images, without a `flush`.
_MOST_WAITING, _MOST_IMAGE_BYTES = 8192, 4 * 2**20

#: Categories of sensors that ``used`` simulates and records as ``all`` does, every reading as it
#: was: what the robot believes of its motion, and what its driver asks for.
EXACT = frozenset({"odometry", "joystick"})

_P = ParamSpec("_P")


def _later(
    write: Callable[Concatenate[RecordingWriter, _P], None],
) -> Callable[Concatenate[RecordingWriter, _P], None]:
    """Defer a call to the next flush, in order."""

    @wraps(write)
    def put_off(self: RecordingWriter, *given: _P.args, **named: _P.kwargs) -> None:
        self._waiting.append(partial(write, self, *given, **named))
        if len(self._waiting) >= _MOST_WAITING:
            self._catch_up()

    return cast("Callable[Concatenate[RecordingWriter, _P], None]", put_off)


class RecordingWriter:
    """Writes the simulation's data; all times are simulated seconds, >= 0.

    The writer takes ownership of arrays, except those of readings, which it copies.
    """

    def __init__(
        self,
        path: Path,
        header: RecordingHeader,
        *,
        record: Literal["all", "used", "none"] = "all",
        choosers: Sequence[CandidateGroup] = (),
        description: str = "",
        beside: RecordingWriter | None = None,
        wheels: Sequence[str] = (),
    ) -> None:
        """Start the file with its header.

        Args:
            path: file to write; the caller renames it when the run is complete.
            header: constants of the run.
            record: ``none`` keeps only data for scores; ``used`` adds scans, cones and images with
                the rate and resolution of the replay page, and data for viewers; ``all`` has every
                reading and image, and all messages for ROS tools.
            choosers: people with known candidates, which makes the file smaller; each in at most
                one group.
            description: the robot's URDF, omitted with ``none``.
            beside: writer of shared data to the same file; the header then has a namespace.
            wheels: joints of the driven wheels in ``description``, left and right, if it has any;
                recorded with ``all``.

        Raises:
            InputError: the path cannot be written.
        """
        self._file: McapFile = (
            McapFile(path) if beside is None else NamespacedFile(beside._file, header.namespace)
        )
        header = with_frames(header)
        self._images = record != "none"
        self._whole = record == "all"
        cameras = {n: i for n, i in header.sensors.items() if i.camera is not None}
        width = None if self._whole else REPLAY_IMAGE_WIDTH
        self._cameras = {n: CameraMessages(n, i, width) for n, i in cameras.items()}
        rate = None if self._whole else REPLAY_IMAGE_RATE
        self._frames = {n: Thinning(rate) for n in cameras}
        ranging = {n: i for n, i in header.sensors.items() if n not in cameras}
        self._sensors = sensor_topics(ranging, header.namespace)
        seen = {n: i for n, i in header.sensors.items() if is_scan(i) or is_cone(i)}
        self._thinning = {n: Thinning(REPLAY_RATE) for n in (seen if record == "used" else ())}
        exact = {n for n, i in ranging.items() if i.category in EXACT}
        self._exact = exact if record == "used" else set()
        known = [group for group in choosers if group.fits]
        people = 0 if header.agents is None else len(header.agents.id)
        self._states, self._trip = StatesWriter(people, known), trip()
        self._samples: list[StateSample] = []
        self._series = {topic: SeriesRows() for topic in (Topic.SIGNAL, Topic.PLANNER_TIME)}
        self._waiting: list[Callable[[], None]] = []
        self._drawn: dict[str, Thinning] = {}
        self._base = in_namespace(header.namespace, "base_link")
        self._image_bytes = 0
        self._now = 0
        self._closed = False
        self._write_constants(header, known)
        self._wheels = (
            WheelMessages(description, wheels, header.namespace)
            if wheels and description and self._whole
            else None
        )
        self._tools = (
            None
            if record == "none"
            else ToolTopics(self._file, header, description, whole=self._whole)
        )

    def _write_constants(self, header: RecordingHeader, known: Sequence[CandidateGroup]) -> None:
        self._file.put(Topic.HEADER, 0, header.to_message(), latched=True)
        tilts = tilts_message(header.sensors)
        if tilts is not None:
            self._file.put(Topic.TILTS, 0, tilts, latched=True)
        if header.person is not None:
            message = person_task_message(header.person)
            self._file.put(Topic.PERSON_TASK, 0, message, latched=True)
        for group in known:
            self._file.put(Topic.CANDIDATES, 0, group.to_message(), latched=True)

    @_later
    def wheels(self, t: float, angles: Sequence[float]) -> None:
        """Write the angles of the driven wheels, left and right, rad."""
        if self._wheels is not None:
            ns = ros.nanoseconds(t)
            self._file.put(Topic.JOINT_STATES, ns, self._wheels.states(ns, angles))
            self._file.put(Topic.TF, ns, self._wheels.frames(ns, angles))

    def state(
        self,
        t: float,
        robot: Sequence[float] | None,
        agents: Array | None,
        jump: NDArray[np.bool_] | None = None,
        signals: Mapping[str, float] | None = None,
        goals: Array | None = None,
    ) -> None:
        """Write one sample of the log.

        Args:
            t: time, s.
            robot: x, y, theta, v, w; m, rad, m/s, rad/s; world frame. For a robot that can move
                sideways also vx, vy, m/s.
            agents: (4, M) x, y, vx, vy; NaN if absent.
            jump: (M,) people teleported since the last sample.
            signals: name -> value at this time.
            goals: (2, M) x, y of people's goals in the last step; None: unknown.
        """
        self._samples.append(StateSample(t, robot, agents, jump, goals))
        for name, value in (signals or {}).items():
            self.signal(t, name, value)
        if self._tools is not None:
            self._waiting.append(partial(self._tools.state, ros.nanoseconds(t), robot, agents))
        if len(self._samples) >= _MOST_WAITING:
            self._catch_up()

    def reading(self, sensor: str, reading: Reading) -> None:
        """Write one reading of a sensor in the header that is not a camera."""
        thinning = self._thinning.get(sensor)
        whole = self._whole or sensor in self._exact
        if whole or (thinning is not None and thinning.keeps(ros.nanoseconds(reading.stamp))):
            kept = reading.values.copy()
            self._waiting.append(partial(self._measured, sensor, reading.stamp, kept))

    def wants_frame(self, camera: str, stamp: float) -> bool:
        """Return True if `frame` would keep an image of this time (s)."""
        return self._images and self._frames[camera].due(ros.nanoseconds(stamp))

    def frame(self, camera: str, frame: CameraFrame) -> None:
        """Write one image of a camera in the header."""
        if not self._images or not self._frames[camera].keeps(ros.nanoseconds(frame.stamp)):
            return
        self._waiting.append(partial(self._frame_messages, self._cameras[camera], frame))
        self._image_bytes += frame.depth_mm.nbytes
        self._image_bytes += 0 if frame.colour is None else frame.colour.nbytes
        if self._image_bytes >= _MOST_IMAGE_BYTES:
            self._catch_up()

    @_later
    def command(self, t: float, command: Command) -> None:
        """Write the planner's command."""
        if self._tools is not None:
            self._tools.command(ros.nanoseconds(t), command)

    def planner_time(self, t: float, seconds: float) -> None:
        """Write the wall time of one planner step.

        The only number that differs between equal runs.
        """
        self._series[Topic.PLANNER_TIME].add("planner_step_time", t, seconds)

    def signal(self, t: float, name: str, value: float) -> None:
        """Write one value of a named signal."""
        self._series[Topic.SIGNAL].add(name, t, value)

    def wants_drawing(self, t: float, name: str) -> bool:
        """Return True if `drawing` would keep a drawing of this name and time (s)."""
        if self._tools is None:
            return False
        last = self._drawn.get(name)
        return last is None or last.due(ros.nanoseconds(t))

    def drawing(self, t: float, drawn: Drawn) -> None:
        """Write a planner's drawing, at the replay page's rate unless everything is recorded."""
        if self._tools is None:
            return
        rate = None if self._whole else REPLAY_RATE
        if self._drawn.setdefault(drawn.name, Thinning(rate)).keeps(ros.nanoseconds(t)):
            self._waiting.append(partial(self._draw, t, drawn))

    def _draw(self, t: float, drawn: Drawn) -> None:
        ns = ros.nanoseconds(t)
        self._file.put(*drawing_message(ns, self._base, drawn))

    @_later
    def trip(self, agent: int, t0: float, t1: float, reached: bool) -> None:
        """Write a trip, finished or not."""
        data = self._trip.fill(whole_trip(agent, t0, t1, reached))
        self._file.put_bytes(Topic.TRIP, ros.nanoseconds(t1), self._trip.msgtype, data)

    @_later
    def contact(
        self,
        t0: float,
        t1: float,
        agent: int,
        impulse: float,
        peak_force: float,
        relative_speed: float,
        bearing: float = math.nan,
    ) -> None:
        """Write a contact of the robot that ended at ``t1``; N s, N, m/s; agent -1 is a wall.

        ``bearing`` points to the first point of contact, in the robot's frame (rad); NaN: unknown.
        """
        message = ros.new(
            "crowdbot_msgs/Contact",
            header=ros.header(ros.nanoseconds(t0), "map"),
            t0=t0,
            t1=t1,
            agent=agent,
            impulse=impulse,
            peak_force=peak_force,
            relative_speed=relative_speed,
            bearing=bearing,
        )
        self._file.put(Topic.CONTACTS, ros.nanoseconds(t1), message)
        if self._tools is not None:
            self._tools.contact(t0, ros.nanoseconds(t1), agent, bearing)

    def flush(self) -> None:
        """Finish the open chunk, so that everything so far is readable if the process is killed.

        Chunks end at these calls: call it by simulated time to keep files comparable.
        """
        self._catch_up()
        self._say_path()
        self._file.flush()

    def close(
        self, goal_time: float | None, complete: bool, status: str, until: float | None = None
    ) -> None:
        """Write the end, index and footer; wait for the disk. A second call does nothing.

        Args:
            goal_time: the robot's arrival, s, or None.
            complete: False for an interrupted run.
            status: ``arrived``, ``timeout``, ``toppled``, ``planner_failed``, …
            until: end of the run, s; default: the last sample.
        """
        if self._closed:
            return
        self._closed = True
        self._catch_up()
        self._say_path()
        end = ros.new(
            "crowdbot_msgs/RunEnd",
            complete=complete,
            status=status,
            arrived=goal_time is not None,
            goal_time=0.0 if goal_time is None else goal_time,
        )
        now = self._now if until is None else ros.nanoseconds(until)
        self._file.put(Topic.END, now, end, latched=True)
        self._file.close()

    @property
    def written(self) -> Written | None:
        """Return the hash and size of the file, once it is closed."""
        return self._file.written

    def _catch_up(self) -> None:
        """Write all buffered data, samples first."""
        if self._samples:
            samples, self._samples = self._samples, []
            self._now = ros.nanoseconds(samples[-1].t)
            changes, states = self._states.messages(samples)
            if changes is not None:
                self._file.put(Topic.PERSON_GOALS, self._now, changes)
            self._file.put(Topic.STATE, self._now, states)
        for topic, rows in self._series.items():
            for t, message in rows.messages():
                self._file.put(topic, ros.nanoseconds(t), message)
        waiting, self._waiting, self._image_bytes = self._waiting, [], 0
        for write in waiting:
            write()

    def _measured(self, sensor: str, stamp: float, values: Array) -> None:
        topic, ns = self._sensors[sensor], ros.nanoseconds(stamp)
        if not (self._whole or sensor in self._exact):
            values = whole_centimetres(values)
        data = topic.message(ns, values)
        self._file.put_bytes(topic.name, ns, topic.msgtype, data)
        if self._tools is not None and self._whole:
            self._tools.measured(sensor, ns, topic.msgtype, data, values)

    def _say_path(self) -> None:
        """Write the path once per simulated second, and at the end."""
        if self._tools is not None and self._whole:
            self._tools.path(self._now)

    def _frame_messages(self, camera: CameraMessages, frame: CameraFrame) -> None:
        ns = ros.nanoseconds(frame.stamp)
        for image in camera(frame):
            self._file.put_bytes(image.topic, ns, image.msgtype, *image.pieces)
