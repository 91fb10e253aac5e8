"""Read the commands of a user and of shared control from the topics of a recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError, UnknownNameError

#: Time, ns; speed, m/s; yaw rate, rad/s.
TwistRow = tuple[int, float, float]
_TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_HEADER = "crowdbot_msgs/msg/RunHeader"


def read_commands(
    path: Path,
    user_topic: str,
    command_topic: str,
    *,
    v_max: float | None = None,
    w_max: float | None = None,
) -> Commands:
    """Return the commands on two topics of Twist or TwistStamped, by log time.

    Each command holds until the next one of its topic; the record starts when both topics have a
    message, and the last command holds until the end of the file.

    Args:
        path: a recording.
        user_topic: commands of the user.
        command_topic: final commands, of shared control.
        v_max: largest speed, m/s; default: that of the robot in a recording of crowdbot.
        w_max: largest yaw rate, rad/s; likewise.

    Raises:
        InputError: not an MCAP file, a topic is empty or has another type, or limits are unknown.
        UnknownNameError: there is no such topic.
    """
    by_topic: dict[str, list[TwistRow]] = {user_topic: [], command_topic: []}
    topics: set[str] = set()
    limits: tuple[float, float] | None = None
    end = 0
    for record in Records(path):
        topics.add(record.topic)
        end = max(end, record.ns)
        if record.topic in by_topic:
            by_topic[record.topic].append(twist_row(path, record))
        elif record.topic.endswith(Topic.HEADER) and record.msgtype == _HEADER:
            limits = limits or _limits(record)
    for topic, rows in by_topic.items():
        if not rows:
            raise UnknownNameError(f"topic of {path}", topic, topics)
    if v_max is None or w_max is None:
        if limits is None:
            raise InputError(
                f"{path}: the robot's limits are not recorded; v_max, w_max are needed"
            )
        v_max, w_max = limits[0] if v_max is None else v_max, limits[1] if w_max is None else w_max
    return commands_of(
        path, by_topic[user_topic], by_topic[command_topic], end, v_max=v_max, w_max=w_max
    )


def commands_of(
    path: Path,
    user: list[TwistRow],
    final: list[TwistRow],
    end: int,
    *,
    v_max: float,
    w_max: float,
) -> Commands:
    """Return the commands of both lists, neither of which is empty, until a time (ns).

    Raises:
        InputError: a number or a limit is not usable.
    """
    t, v_user, v_final, t_end = _merged(user, final, end)
    try:
        return Commands.from_arrays(
            t=t,
            v_user=v_user[:, 0],
            w_user=v_user[:, 1],
            v_sc=v_final[:, 0],
            w_sc=v_final[:, 1],
            v_max=v_max,
            w_max=w_max,
            t_end=t_end,
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def twist_row(path: Path, record: Record) -> TwistRow:
    """Return a command of Twist or TwistStamped.

    Raises:
        InputError: it is of another type, or damaged.
    """
    if record.msgtype not in _TWISTS or record.encoding != "cdr":
        found = record.msgtype or "a message without schema"
        raise InputError(f"{path}: {record.topic} holds {found}, not {' or '.join(_TWISTS)} (cdr)")
    try:
        message = ros.from_cdr(record.data, record.msgtype)
    except Exception as error:  # the decoder is generated code and may raise anything
        raise InputError(f"{path}: {record.topic}: a message that cannot be decoded") from error
    twist = message.twist if record.msgtype.endswith("Stamped") else message
    return record.ns, float(twist.linear.x), float(twist.angular.z)


def _limits(record: Record) -> tuple[float, float] | None:
    try:
        header = RecordingHeader.from_message(ros.from_cdr(record.data, record.msgtype))
    except Exception:  # a reader of the run says what is wrong with it
        return None
    if header.robot is None or header.robot.limits is None:
        return None
    return header.robot.limits.v_max, header.robot.limits.w_max


def _merged(
    user: list[TwistRow], final: list[TwistRow], end: int
) -> tuple[Array, Array, Array, float]:
    """Return times (N,), s from the first; user's and final v and w (N, 2); end, s."""
    # a dict keeps the last of several commands with the same time
    series = [
        {ns: (v, w) for ns, v, w in sorted(rows, key=lambda r: r[0])} for rows in (user, final)
    ]
    start = max(min(rows) for rows in series)
    times = np.array(sorted({start, *(ns for rows in series for ns in rows if ns > start)}))
    held = []
    for rows in series:
        known = np.array(list(rows))
        values = np.array(list(rows.values()), np.float64)
        held.append(values[np.searchsorted(known, times, side="right") - 1])
    return (times - start) / 1e9, held[0], held[1], (max(end, int(times[-1])) - start) / 1e9
