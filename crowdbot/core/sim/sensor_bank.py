"""SensorBank: all sensors of one robot, each at its own rate, by integer tick arithmetic.

Its event is unrestricted like the crowd's, so that robot and crowd are seen at the same instant.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, DiscreteStateIndex, LeafSystem, State

from crowdbot.core.crowd import state as s
from crowdbot.core.interfaces import (
    Pose,
    Reading,
    RobotState,
    Sensor,
    SensorInfo,
    SensorWithMemory,
)
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim import ports
from crowdbot.core.ticks import TICK, is_due

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Slot:
    """Where a sensor's stamp, values and memory lie in the bank's state vector."""

    info: SensorInfo
    stamp: int
    values: slice
    memory: slice

    def reading(self, state: Array) -> Reading:
        """The latest reading, copied and read-only."""
        values = state[self.values].reshape(self.info.shape).copy()
        values.setflags(write=False)
        return Reading(float(state[self.stamp]), values)


def lay_out(infos: Mapping[str, SensorInfo]) -> tuple[dict[str, Slot], int]:
    """Slots by sensor name and the length of the state vector; entry 0 is the tick."""
    slots, end = {}, 1
    for name, info in infos.items():
        values_end = end + 1 + int(np.prod(info.shape))
        memory_end = values_end + info.memory
        slots[name] = Slot(info, end, slice(end + 1, values_end), slice(values_end, memory_end))
        end = memory_end
    return slots, end


class SensorBank(LeafSystem):
    """Inputs: robot and crowd state. Output: latest readings of all sensors."""

    def __init__(
        self,
        sensors: Mapping[str, Sensor | SensorWithMemory],
        scene: Scene,
        crowd_size: int,
        *,
        seed: int,
        robot: str,
    ) -> None:
        super().__init__()
        self._sensors, self._scene = dict(sensors), scene
        self._seed, self._robot_name = seed, robot
        self.slots, size = lay_out({n: x.info() for n, x in sensors.items()})
        initial = np.zeros(size)
        for slot in self.slots.values():
            initial[slot.stamp] = -1.0
        self._robot = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        self._crowd = (
            self.DeclareVectorInputPort(ports.CROWD_STATE, crowd_size) if crowd_size else None
        )
        index = self.DeclareDiscreteState(initial)
        self.DeclareStateOutputPort(ports.READINGS, index)
        self._index = DiscreteStateIndex(index)
        self.DeclarePeriodicUnrestrictedUpdateEvent(TICK, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        bank = state.get_mutable_discrete_state().get_mutable_value(self._index)
        tick = int(bank[0])
        bank[0] = tick + 1
        due = [n for n, slot in self.slots.items() if is_due(tick, slot.info.rate)]
        if not due:
            return
        robot = RobotState(*self._robot.Eval(context).tolist())
        self._see(context, robot)
        pose = Pose(robot.x, robot.y, robot.yaw)
        for name in due:
            self._read(name, bank, pose, tick)

    def _see(self, context: Context, robot: RobotState) -> None:
        if self._crowd is None:
            people, present = np.zeros((0, 4)), np.zeros(0, np.bool_)
        else:
            _, rows = s.view(self._crowd.Eval(context))
            people, present = rows[:, s.X : s.VY + 1], rows[:, s.WAITING] == 0.0
        self._scene.update(robot, people, present)

    def _read(self, name: str, bank: Array, pose: Pose, tick: int) -> None:
        slot, sensor = self.slots[name], self._sensors[name]
        rng = sensor_rng(self._seed, self._robot_name, name, tick)
        t = tick * TICK
        if slot.info.memory:
            memory = bank[slot.memory]
            values = sensor.read(self._scene, pose, t, rng, memory)  # type: ignore[call-arg]
        else:
            values = sensor.read(self._scene, pose, t, rng)  # type: ignore[call-arg]
        bank[slot.stamp] = t
        bank[slot.values] = np.ravel(values)
