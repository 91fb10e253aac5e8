"""Messages from the simulator to a planner process, as maps of plain values.

docs/reference/planner_messages.md describes them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.planning.planner import Observation, Truth
from crowdbot.core.planning.process.shared_memory import SharedMemory, in_message
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import Reading, SensorInfo
from crowdbot.core.types.task import Task

_INFO = ("category", "frame", "rate", "ros_type", "range_min", "range_max", "privileged")


def reset_message(
    task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
) -> dict[str, Any]:
    """Return the message ``reset``, without the size of the shared memory."""
    person = {} if task.person is None else {"person": asdict(task.person)}
    return {
        "type": "reset",
        "task": {
            "start": [float(x) for x in task.start],
            "goal": [float(x) for x in task.goal],
            "goal_zone": _array(task.goal_zone),
            "time_limit": float(task.time_limit),
            "robot": None if task.robot is None else _body(task.robot),
            **person,
        },
        "limits": {name: float(value) for name, value in asdict(limits).items()},
        "sensors": {name: _sensor(info) for name, info in sensors.items()},
        "seed": int(seed),
        "memory": 0,
    }


class ObservationWriter:
    """Builds ``observe`` messages; constant parts are built once.

    Args:
        memory: shared memory for large arrays; None: send them in the message.
    """

    def __init__(self, memory: SharedMemory | None) -> None:
        self._memory = memory
        self._zone: Any = None
        self._zone_map: dict[str, Any] = {}

    def message(self, step: int, obs: Observation) -> dict[str, Any]:
        """Return the planner's input in one step."""
        if obs.goal_zone is not self._zone:
            self._zone, self._zone_map = obs.goal_zone, _array(obs.goal_zone)
        message = {
            "type": "observe",
            "step": step,
            "t": float(obs.t),
            "pose": [float(x) for x in obs.pose],
            "twist": [float(x) for x in obs.twist],
            "vy": float(obs.vy),
            "goal": [float(x) for x in obs.goal],
            "goal_zone": self._zone_map,
            "readings": {n: _reading(n, r, self._memory) for n, r in obs.readings.items()},
        }
        if obs.person is not None:
            message["person"] = {n: float(x) for n, x in asdict(obs.person).items()}
        if obs.truth is not None:
            message["truth"] = _truth(obs.truth)
        return message


def reserve(memory: SharedMemory, sensors: Mapping[str, SensorInfo]) -> None:
    """Reserve a place for each array of the sensors' readings."""
    for name, info in sensors.items():
        width = 4 if info.camera else 8
        memory.place(name, "values", int(np.prod(info.shape)) * width)
        if info.camera and info.camera.colour:
            memory.place(name, "colour", 3 * info.camera.width * info.camera.height)


def _sensor(info: SensorInfo) -> dict[str, Any]:
    return {
        **{name: getattr(info, name) for name in _INFO},
        "mount": [float(x) for x in info.mount],
        "tilt": [float(x) for x in info.tilt],
        "shape": [int(n) for n in info.shape],
        "angles": None if info.angles is None else _array(info.angles),
        "camera": None if info.camera is None else asdict(info.camera),
    }


def _reading(name: str, reading: Reading, memory: SharedMemory | None) -> dict[str, Any]:
    put = _in_message if memory is None else memory.put
    message: dict[str, Any] = {
        "stamp": float(reading.stamp),
        "values": put(name, "values", reading.values),
    }
    if reading.colour is not None:
        message["colour"] = put(name, "colour", reading.colour)
    return message


def _in_message(name: str, part: str, array: NDArray[Any]) -> dict[str, Any]:
    del name, part
    return in_message(np.ascontiguousarray(array))


def _body(body: RobotBody) -> dict[str, Any]:
    footprint = None if body.footprint is None else _array(body.footprint)
    numbers = {n: float(getattr(body, n)) for n in ("radius", "front", "back", "half_width")}
    return {"drive": body.drive, "footprint": footprint, **numbers}


def _truth(truth: Truth) -> dict[str, Any]:
    arrays = {n: _array(getattr(truth, n)) for n in Truth.__slots__ if n.startswith("people")}
    return {
        "pose": [float(x) for x in truth.pose],
        "velocity": [float(x) for x in truth.velocity],
        **arrays,
    }


def _array(values: Any) -> dict[str, Any]:
    return in_message(np.ascontiguousarray(values))
