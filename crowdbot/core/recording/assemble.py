"""Puts the scoring topics of a recording together into `Trajectories`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Array
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectory import Trajectories
from crowdbot.errors import InputError

#: The last two are recorded of a robot that goes sideways.
_ROBOT = ("x", "y", "theta", "v", "w", "vx", "vy")
_CONTACT = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed")


class Collected:
    """Messages of the scoring topics, in the order they came."""

    #: Topic -> message type.
    TOPICS: ClassVar[Mapping[str, str]] = {
        Topic.HEADER: "crowdbot_msgs/msg/RunHeader",
        Topic.STATE: "crowdbot_msgs/msg/RunState",
        Topic.TRIP: "crowdbot_msgs/msg/Trip",
        Topic.CONTACTS: "crowdbot_msgs/msg/Contact",
        Topic.SIGNAL: "crowdbot_msgs/msg/Signal",
        Topic.PLANNER_TIME: "crowdbot_msgs/msg/Signal",
        Topic.END: "crowdbot_msgs/msg/RunEnd",
    }

    def __init__(self) -> None:
        self._by_topic: dict[str, list[Any]] = {t: [] for t in self.TOPICS}

    def add(self, topic: str, message: Any) -> None:
        """Take one message of one of `TOPICS`."""
        self._by_topic[topic].append(message)

    def trajectories(self, path: Path) -> Trajectories:
        """All of it as arrays.

        Raises:
            InputError: header or samples are missing, or do not fit each other.
        """
        if not self._by_topic[Topic.HEADER]:
            raise InputError(f"{path}: no recording of crowdbot: {Topic.HEADER} is missing")
        if not self._by_topic[Topic.STATE]:
            raise InputError(f"{path}: the recording holds no sample")
        header = RecordingHeader.from_message(self._by_topic[Topic.HEADER][0])
        try:
            return Trajectories.from_arrays(
                **self._shared(header), **self._robot(header), **self._agents(header)
            )
        except (InputError, ValueError) as error:
            raise InputError(f"{path}: damaged: {error}") from error

    def _shared(self, header: RecordingHeader) -> dict[str, Any]:
        return {
            "t": [s.t for s in self._by_topic[Topic.STATE]],
            "goal_zone": header.goal_zone,
            "walls": header.walls,
            "planner_step_time": [s.value for s in self._by_topic[Topic.PLANNER_TIME]] or None,
            "signals": self._signals(),
        }

    def _robot(self, header: RecordingHeader) -> dict[str, Any]:
        robot = header.robot
        if robot is None:
            return {}
        names = _ROBOT if len(self._by_topic[Topic.STATE][0].robot) == len(_ROBOT) else _ROBOT[:5]
        rows = _rows(self._by_topic[Topic.STATE], "robot", len(names))
        ends = self._by_topic[Topic.END]
        return {
            **{f"robot_{name}": column for name, column in zip(names, rows.T, strict=True)},
            "robot_radius": robot.radius,
            "robot_mass": robot.mass,
            "robot_goal_time": ends[0].goal_time if ends and ends[0].arrived else None,
            "robot_goal": robot.goal,
            "robot_goal_radius": robot.goal_radius,
            "robot_footprint": robot.footprint,
            "contacts": _columns(self._by_topic[Topic.CONTACTS], _CONTACT),
        }

    def _agents(self, header: RecordingHeader) -> dict[str, Any]:
        agents = header.agents
        if agents is None:
            return {}
        states, m = self._by_topic[Topic.STATE], len(agents.id)
        rows = _rows(states, "agents", 4 * m).reshape(len(states), 4, m)
        names = ("agent_x", "agent_y", "agent_vx", "agent_vy")
        trips = _columns(self._by_topic[Topic.TRIP], ("agent", "t0", "t1", "reached"))
        return {
            **{name: rows[:, i] for i, name in enumerate(names)},
            "agent_id": agents.id,
            "agent_radius": agents.radius,
            "agent_mass": agents.mass,
            "agent_jump": _jump(states, m),
            **{f"trip_{name}": column for name, column in trips.items()},
        }

    def _signals(self) -> dict[str, Array]:
        series: dict[str, list[tuple[float, float]]] = {}
        for s in self._by_topic[Topic.SIGNAL]:
            series.setdefault(s.name, []).append((s.t, s.value))
        return {name: np.array(rows, np.float64) for name, rows in series.items()}


def _rows(states: list[Any], name: str, width: int) -> Array:
    if any(getattr(s, name).shape != (width,) for s in states):
        raise InputError(f"a sample of the {name} does not have {width} numbers")
    return np.array([getattr(s, name) for s in states], np.float64).reshape(len(states), width)


def _jump(states: list[Any], m: int) -> NDArray[np.bool_] | None:
    """(N-1, M), or None where no sample told; the first sample has nothing before it."""
    if not any(s.has_jump for s in states):
        return None
    jump = np.zeros((len(states) - 1, m), np.bool_)
    for row, state in zip(jump, states[1:], strict=True):
        if state.has_jump:
            row[:] = state.jump
    return jump


def _columns(rows: list[Any], names: tuple[str, ...]) -> dict[str, list[Any]]:
    return {name: [getattr(row, name) for row in rows] for name in names}
