"""SensorBank: all sensors of one robot, each at its own rate, in integer ticks.

Its event is unrestricted like the crowd's, so that robot and crowd are seen at the same time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from pydrake.systems.framework import Context, DiagramBuilder, State

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as s
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.sensing.noise import SensorStream
from crowdbot.core.sensing.other_robots import OtherRobot
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sensing.sensor import Sensor, SensorWithMemory
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.cameras.images import Graphics, Images, capture, view_size
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.other_robots import OtherRobots
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, is_due
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotModel, RobotState
from crowdbot.core.types.sensor import Reading, SensorInfo


@dataclass(frozen=True, slots=True)
class Slot:
    """Offsets of a sensor's stamp, values and memory in the bank's state vector.

    The ``values`` of a camera are the scene in view, see `crowdbot.core.sim.cameras.images`.
    """

    info: SensorInfo
    stamp: int
    values: slice
    memory: slice

    def reading(self, state: Array) -> Reading:
        """Return the latest reading, as a read-only part of the state."""
        values = state[self.values].reshape(self.info.shape)
        values.setflags(write=False)
        return Reading(float(state[self.stamp]), values)


class _SensorReader(NamedTuple):
    """Data for taking a reading: its slot, its sensor, its random numbers."""

    slot: Slot
    read: Callable[..., Array]
    stream: SensorStream | None


def lay_out(
    infos: Mapping[str, SensorInfo], people: int, robots: int = 0
) -> tuple[dict[str, Slot], int]:
    """Return slots by sensor name and the length of the state vector; entry 0 is the tick."""
    slots, end = {}, 1
    for name, info in infos.items():
        size = view_size(people, robots) if info.camera else int(np.prod(info.shape))
        values_end = end + 1 + size
        memory_end = values_end + info.memory
        slots[name] = Slot(info, end, slice(end + 1, values_end), slice(values_end, memory_end))
        end = memory_end
    return slots, end


def ticks_between(rates: Iterable[float]) -> int:
    """Return the largest power of two, up to 128, that divides every sample time of every rate."""
    periods = [TICKS_PER_SECOND / rate for rate in rates]
    if not all(p.is_integer() for p in periods):
        return 1
    return math.gcd(TICKS_PER_SECOND, *(int(p) for p in periods))


class Timetable:
    """Sensors due at each tick; cached if the schedule is periodic."""

    _LONGEST = 1024  # largest period in ticks that is cached

    def __init__(self, rates: Mapping[str, float]) -> None:
        self._rates = dict(rates)
        periods = [TICKS_PER_SECOND / rate for rate in self._rates.values()]
        self._turns: list[tuple[str, ...]] = []
        if all(p.is_integer() for p in periods):
            cycle = math.lcm(*(int(p) for p in periods))
            if cycle <= self._LONGEST:
                self._turns = [self._at(tick) for tick in range(cycle)]

    def __call__(self, tick: int) -> tuple[str, ...]:
        """Return the names of the sensors, in order."""
        return self._turns[tick % len(self._turns)] if self._turns else self._at(tick)

    def _at(self, tick: int) -> tuple[str, ...]:
        return tuple(n for n, rate in self._rates.items() if is_due(tick, rate))


class SensorBank(Block):
    """Inputs: robot and crowd state. Output: latest readings of all sensors.

    Entry 0 of the output is the next tick with a due sensor.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        sensors: Mapping[str, Sensor | SensorWithMemory],
        scene: Scene,
        crowd: CrowdSystem | None,
        others: OtherRobots,
        *,
        seed: int,
        robot: str,
        writer: RecordingWriter,
        renderers: Mapping[str, Graphics] = MappingProxyType({}),
    ) -> None:
        """Build the bank.

        Args:
            crowd: the people, if there are any.
            others: the other robots, and the ending of this one.
            writer: gets each reading, and those images that it asks for.
            renderers: what draws the colour images of cameras, by the camera's name.
        """
        super().__init__()
        self._scene = scene
        self._poses: list[Pose | None] = []
        self._writer, self._on_reading = writer, writer.reading
        self._idle = SensorStream(seed, robot, "").at(0)
        people = 0 if crowd is None else len(crowd.engine.agents)
        self._ending, self._others = others.ending, others
        self.slots, size = lay_out(
            {n: x.info() for n, x in sensors.items()}, people, len(scene.others)
        )
        self._readers = {
            n: _SensorReader(
                x, sensors[n].read, SensorStream(seed, robot, n) if x.info.random else None
            )
            for n, x in self.slots.items()
        }
        self._renderers = tuple(renderers.values())
        self._images = {
            n: Images(sensors[n], partial(self._rng, n), renderers.get(n))  # type: ignore[arg-type]
            for n, slot in self.slots.items()
            if slot.info.camera
        }
        self._declare_inputs(crowd, len(others.states))
        initial = np.zeros(size)
        for slot in self.slots.values():
            initial[slot.stamp] = -1.0
        index = self.DeclareDiscreteState(initial)
        self.DeclareStateOutputPort(ports.READINGS, index)
        self._index = int(index)
        rates = {n: x.info.rate for n, x in self.slots.items()}
        self._step = ticks_between(rates.values())
        self._due = Timetable(rates)
        infos = {n: x.info for n, x in self.slots.items()}
        self._blind = {n for n, i in infos.items() if not (i.sees or i.feels or i.camera)}
        self.DeclarePeriodicUnrestrictedUpdateEvent(self._step * TICK, 0.0, self._update)

    def _declare_inputs(self, crowd: CrowdSystem | None, other_robots: int) -> None:
        declare = self.DeclareVectorInputPort
        self._robot = declare(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
        self._crowd = None if crowd is None else declare(ports.CROWD_STATE, crowd.state.size())
        self._states = [declare(*ports.other_robot(k)) for k in range(other_robots)]
        self._pushed = declare(ports.ROBOT_PUSH, ports.ROBOT_PUSH_SIZE) if other_robots else None

    def reading(self, name: str, bank: Array) -> Reading:
        """Return the latest reading in a state of the bank, read-only."""
        slot = self.slots[name]
        if name not in self._images:
            return slot.reading(bank)
        return self._images[name].reading(self._scene, float(bank[slot.stamp]), bank[slot.values])

    def _rng(self, name: str, t: float) -> np.random.Generator:
        """Return the random generator of one reading; a shared idle one without a random stream."""
        stream = self._readers[name].stream
        return self._idle if stream is None else stream.at(round(t * TICKS_PER_SECOND))

    def _update(self, context: Context, state: State) -> None:
        bank = state.get_mutable_discrete_state().get_mutable_value(self._index)
        tick = int(bank[0])
        bank[0] = tick + self._step
        due = self._due(tick)
        if not due or self._ending.ended:
            return
        robot, people = RobotState(*self._robot.Eval(context).tolist()), None
        if self._blind.issuperset(due):
            self._scene.move_robot(robot)
        else:
            people = self._see(context, robot)
        pose, t = Pose(robot.x, robot.y, robot.yaw), tick * TICK
        for name in due:
            if name in self._images:
                self._take_frame(name, people, bank, robot, pose, t)
            else:
                self._read(name, bank, pose, t, tick)

    def _take_frame(
        self, name: str, people: Array | None, bank: Array, robot: RobotState, pose: Pose, t: float
    ) -> None:
        slot = self.slots[name]
        bank[slot.stamp] = t
        view = bank[slot.values]
        capture(robot, people, view, self._poses)
        if self._writer.wants_frame(name, t):
            image = self._images[name].frame(self._scene, pose, t, view)
            self._writer.frame(name, image)

    def _see(self, context: Context, robot: RobotState) -> Array | None:
        """Update the scene; return the crowd's rows, if any."""
        push = (0.0, 0.0, 0.0)
        if self._pushed is not None:
            self._show_others(context)
            push = self._pushed.Eval(context).tolist()
        if self._crowd is None:
            self._scene.update(robot, np.zeros((0, 4)), np.zeros(0, np.bool_), push=push)
            return None
        crowd = self._crowd.Eval(context)
        (_, rows), (feels, _) = s.view(crowd), s.contact_with(crowd, self._others.number)
        felt = feels[s.ROBOT_FX], feels[s.ROBOT_FY], feels[s.ROBOT_TORQUE]
        self._scene.update(
            robot,
            rows[:, s.X : s.VY + 1],
            rows[:, s.WAITING] == 0.0,
            rows[:, s.DIR_X : s.DIR_Y + 1],
            rows[:, s.WALKED],
            felt if self._pushed is None else tuple(a + b for a, b in zip(felt, push, strict=True)),
        )
        return rows

    def _show_others(self, context: Context) -> None:
        """Update the other robots' poses in the scene."""
        states = (port.Eval(context)[:3].tolist() for port in self._states)
        ends = self._others.endings
        self._poses = [None if e.gone else Pose(*p) for e, p in zip(ends, states, strict=True)]
        self._scene.show_robots(self._poses)

    def _read(self, name: str, bank: Array, pose: Pose, t: float, tick: int) -> None:
        slot, read, stream = self._readers[name]
        rng = self._idle if stream is None else stream.at(tick)
        if slot.info.memory:
            values = read(self._scene, pose, t, rng, bank[slot.memory])
        else:
            values = read(self._scene, pose, t, rng)
        bank[slot.stamp] = t
        bank[slot.values] = values if values.ndim == 1 else values.ravel()
        self._on_reading(name, Reading(t, values))

    def close(self) -> None:
        """Free the graphics of the cameras.

        A graphics context belongs to the thread that drew in it, and the diagram may live on until
        Python collects it in another one: there each mesh would fail to make the context current.
        """
        for renderer in self._renderers:
            renderer.close()
        self._renderers = ()


def add_sensors(
    builder: DiagramBuilder,
    built: BuiltRun,
    robot: ControlledRobot,
    crowd: CrowdSystem | None,
    writer: RecordingWriter,
    others: OtherRobots,
    *,
    seed: int,
) -> SensorBank:
    """Add the sensors of a robot to a diagram.

    They see the robot and the people of the same tick, and see and feel the other robots.
    """
    scene = _scene(built, None if crowd is None else crowd.engine, others.models)
    bank = SensorBank(
        built.sensors,
        scene,
        crowd,
        others,
        seed=seed,
        robot=built.name,
        writer=writer,
        renderers=_renderers(built, scene, others.models),
    )
    builder.AddNamedSystem("sensors", bank)
    builder.Connect(robot.port, bank.GetInputPort(ports.ROBOT_STATE))
    if crowd is not None:
        builder.Connect(crowd.state, bank.GetInputPort(ports.CROWD_STATE))
    for k, state in enumerate(others.states):
        builder.Connect(state, bank.GetInputPort(ports.other_robot(k)[0]))
    if others.push is not None:
        builder.Connect(others.push, bank.GetInputPort(ports.ROBOT_PUSH))
    return bank


def _scene(built: BuiltRun, engine: CrowdEngine | None, others: Sequence[RobotModel]) -> Scene:
    crowd, parts = built.scenario.crowd, built.parts
    radius = np.zeros(0) if engine is None else engine.agents.radius
    height = np.full(len(radius), crowd.body.height if crowd else 0.0)
    looks = None if engine is None else engine.agents.looks
    seen = [OtherRobot(footprint_of_model(model), model.height) for model in others]
    return Scene(
        parts.walls, parts.wall_heights, radius, height, parts.pillars, parts.pillar_heights,
        looks, seen,
    )  # fmt: skip


def _renderers(built: BuiltRun, scene: Scene, others: Sequence[RobotModel]) -> dict[str, Graphics]:
    """Return renderers of cameras with colour, for which VTK is loaded."""
    cameras = {n: i for n, i in built.infos.items() if i.camera is not None and i.camera.colour}
    if not cameras:
        return {}
    from crowdbot.core.figures.figure import load_figure
    from crowdbot.core.sim.cameras.rendering import Renderer

    crowd = built.scenario.crowd
    figures = [load_figure(asset.file) for asset in crowd.body.figures.values()] if crowd else []
    return {
        n: Renderer(scene, i.camera, i.mount, i.tilt, others, built.parts.light, figures)
        for n, i in cameras.items()
        if i.camera
    }
