"""SensorBank: all sensors of one robot, each at its own rate, by integer tick arithmetic.

Its event is unrestricted like the crowd's, so that robot and crowd are seen at the same instant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
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
from crowdbot.core.ticks import TICK, TICKS_PER_SECOND, is_due

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


def ticks_between(rates: Iterable[float]) -> int:
    """The largest power of two, up to 128, of which every sample of every rate is a multiple."""
    periods = [TICKS_PER_SECOND / rate for rate in rates]
    if not all(p.is_integer() for p in periods):
        return 1
    return math.gcd(TICKS_PER_SECOND, *(int(p) for p in periods))


class SensorBank(LeafSystem):
    """Inputs: robot and crowd state. Output: latest readings of all sensors.

    Entry 0 of the output is the next tick at which a sensor may be due.
    """

    def __init__(
        self,
        sensors: Mapping[str, Sensor | SensorWithMemory],
        scene: Scene,
        crowd_size: int,
        *,
        seed: int,
        robot: str,
        on_reading: Callable[[str, Reading], None],
    ) -> None:
        super().__init__()
        self._sensors, self._scene = dict(sensors), scene
        self._seed, self._robot_name = seed, robot
        self._on_reading = on_reading
        self._not_random = sensor_rng(seed, robot, "", 0)
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
        # Ticks between samples, None where they vary.
        periods = {n: TICKS_PER_SECOND / x.info.rate for n, x in self.slots.items()}
        self._periods = {n: int(p) if p.is_integer() else None for n, p in periods.items()}
        self._step = ticks_between(x.info.rate for x in self.slots.values())
        self.DeclarePeriodicUnrestrictedUpdateEvent(self._step * TICK, 0.0, self._update)

    def _update(self, context: Context, state: State) -> None:
        bank = state.get_mutable_discrete_state().get_mutable_value(self._index)
        tick = int(bank[0])
        bank[0] = tick + self._step
        due = self._due(tick)
        if not due:
            return
        robot = RobotState(*self._robot.Eval(context).tolist())
        self._see(context, robot)
        pose = Pose(robot.x, robot.y, robot.yaw)
        for name in due:
            self._read(name, bank, pose, tick)

    def _due(self, tick: int) -> list[str]:
        return [
            n
            for n, period in self._periods.items()
            if (is_due(tick, self.slots[n].info.rate) if period is None else tick % period == 0)
        ]

    def _see(self, context: Context, robot: RobotState) -> None:
        if self._crowd is None:
            people, present = np.zeros((0, 4)), np.zeros(0, np.bool_)
        else:
            _, rows = s.view(self._crowd.Eval(context))
            people, present = rows[:, s.X : s.VY + 1], rows[:, s.WAITING] == 0.0
        self._scene.update(robot, people, present)

    def _read(self, name: str, bank: Array, pose: Pose, tick: int) -> None:
        slot, sensor = self.slots[name], self._sensors[name]
        rng = self._not_random  # a new generator costs more than a reading of wheel odometry
        if slot.info.random:
            rng = sensor_rng(self._seed, self._robot_name, name, tick)
        t = tick * TICK
        if slot.info.memory:
            memory = bank[slot.memory]
            values = sensor.read(self._scene, pose, t, rng, memory)  # type: ignore[call-arg]
        else:
            values = sensor.read(self._scene, pose, t, rng)  # type: ignore[call-arg]
        bank[slot.stamp] = t
        bank[slot.values] = np.ravel(values)
        self._on_reading(name, slot.reading(bank))
