"""Diagrams for tests: any robot task, any crowd, any planner; the log kept in memory."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.analysis import Simulator

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdView, CrowdWorld
from crowdbot.core.crowd import state as s
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.population.realise import realise
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.task import sensor_context
from crowdbot.core.scenarios.library import open_document, open_spec, pick
from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sim import ports
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.diagram import Blocks, RobotBlocks, RunRobot, build_diagram
from crowdbot.core.sim.plant import RobotPlant
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.support.ticks import TICK
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.expand import Expanding
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.dsl.suite.suite import ParsedSuite
from crowdbot.plugin import CameraFrame, Command, Observation, Planner, Reading, RobotState

Array = NDArray[np.float64]
EASY = "in-d0125-slow-c01-r02"


@cache
def registry() -> Registry:
    return discover()


@cache
def challenge() -> Expansion:
    return open_spec("challenge-2020", registry())


@cache
def document() -> ParsedSuite:
    return open_document("challenge-2020", registry()).suite


def scenario(*overrides: str, id_: str = EASY) -> Scenario:
    """A scenario of the challenge with some fields changed.

    As `pick` of `open_spec` with these, for which all 162 would be expanded.
    """
    unchanged = pick(challenge(), id_)
    index = challenge().scenarios.index(unchanged)
    found = Expanding(document(), registry().scenario_model, overrides).scenario(index)
    assert unchanged.locked is not None
    found.lock_to(unchanged.locked)
    return found


def alone(*overrides: str) -> Scenario:
    """The same without people."""
    return scenario("crowd=null", *overrides)


class Drive:
    """A planner that follows a function of time."""

    def __init__(self, command: Callable[[float], tuple[float, float]]) -> None:
        self.command, self.seen = command, list[Observation]()

    def reset(self, task: object, limits: object, sensors: object, seed: int) -> None:
        pass

    def step(self, obs: Observation) -> Command:
        self.seen.append(obs)
        return Command(*self.command(obs.t))


def constant(v: float, w: float = 0.0) -> Drive:
    return Drive(lambda _: (v, w))


@dataclass
class Memory:
    """Takes the place of a recording."""

    states: list[tuple[float, Any, Any, Any]] = field(default_factory=list)
    readings: dict[str, list[Reading]] = field(default_factory=dict)
    frames: dict[str, list[CameraFrame]] = field(default_factory=dict)
    images: bool = True
    commands: list[tuple[float, Command]] = field(default_factory=list)
    trips: list[tuple[Any, ...]] = field(default_factory=list)
    contacts: list[dict[str, float]] = field(default_factory=list)
    flushes: int = 0

    def state(self, t: float, robot: Any, agents: Any, jump: Any, *, goals: Array | None) -> None:
        del goals
        self.states.append((t, robot, agents, jump))

    def wheels(self, t: float, angles: Any) -> None:
        pass

    def reading(self, name: str, reading: Reading) -> None:
        self.readings.setdefault(name, []).append(reading)

    def wants_frame(self, camera: str, stamp: float) -> bool:
        del camera, stamp
        return self.images

    def frame(self, name: str, frame: CameraFrame) -> None:
        self.frames.setdefault(name, []).append(frame)

    def command(self, t: float, command: Command) -> None:
        self.commands.append((t, command))

    def planner_time(self, t: float, seconds: float) -> None:
        pass

    def signal(self, t: float, name: str, value: float) -> None:
        pass

    def wants_drawing(self, t: float, name: str) -> bool:
        del t, name
        return True

    def drawing(self, t: float, drawn: Any) -> None:
        pass

    def trip(self, agent: int, t0: float, t1: float, reached: bool) -> None:
        self.trips.append((agent, t0, t1, reached))

    def contact(self, **columns: float) -> None:
        self.contacts.append(columns)

    def flush(self) -> None:
        self.flushes += 1


@dataclass
class Rig:
    """A diagram ready to run, with its simulator."""

    blocks: Blocks
    simulator: Any
    memory: Memory
    log: RunLog

    @property
    def context(self) -> Any:
        return self.simulator.get_mutable_context()

    def advance(self, until: float) -> Rig:
        self.simulator.AdvanceTo(until)
        return self

    @property
    def own(self) -> RobotBlocks:
        """The blocks of the only robot."""
        (blocks,) = self.blocks.robots
        return blocks

    @property
    def ending(self) -> RobotEnding:
        """How the robot has ended."""
        return self.own.given.ending

    @property
    def plant(self) -> RobotPlant:
        """The multibody plant of a robot that has one."""
        rig = self.own.base.rig
        assert rig is not None
        return rig

    def robot(self) -> RobotState:
        """The robot's state now."""
        mine = self.own.base.state.GetMyContextFromRoot(self.context)
        port = self.own.base.state.GetOutputPort(ports.ROBOT_STATE)
        return RobotState(*port.Eval(mine).tolist())

    def crowd(self) -> Array:
        """The flat crowd state now, copied."""
        assert self.blocks.crowd is not None
        mine = self.blocks.crowd.GetMyContextFromRoot(self.context)
        return np.array(self.blocks.crowd.GetOutputPort(ports.CROWD_STATE).Eval(mine))

    def everything(self) -> bytes:
        """All discrete state of all blocks, bit by bit."""
        values = self.context.get_discrete_state()
        groups = [values.get_vector(i).CopyToVector() for i in range(values.num_groups())]
        return np.concatenate(groups).tobytes()

    def track(self, until: float, step: float = 1.0 / 64.0) -> list[tuple[float, RobotState]]:
        """The robot's state, sampled on the way."""
        found = []
        while self.context.get_time() < until:
            self.advance(self.context.get_time() + step)
            found.append((self.context.get_time(), self.robot()))
        return found


def rig(
    world: Scenario,
    planner: Planner | Drive,
    engine: CrowdEngine | None = None,
    *,
    sensors: Collection[str] = ("odometry",),
    visible: Collection[str] | None = None,
    images: bool = True,
    seed: int = 0,
    initialize: bool = True,
    body: Mapping[str, Any] | None = None,
    tick: float = TICK,
) -> Rig:
    """Build the diagram of a scenario; ``engine`` replaces the crowd it describes.

    ``visible`` sensors are those that the planner gets, all by default; ``images`` says whether
    they are recorded; ``body`` replaces fields of the robot's model.
    """
    reg = registry()
    ((name, robot),) = world.robots.items()
    parts, model = (
        build_environment(reg, world.environment),
        replace(build_model(reg, robot.model), **(body or {})),
    )
    if engine is None and world.crowd is not None:
        engine = build_crowd(world, realise(world), parts, reg)
    memory = Memory(images=images)
    ids = np.zeros(0, np.int64) if engine is None else engine.agents.id
    log = RunLog(cast(RecordingWriter, memory), ids)
    host = PlannerHost(planner, "test", model.limits)
    carrier = sensor_context(robot, model, parts)
    task = carrier.task
    made = {n: build_sensor(reg, x, carrier) for n, x in robot.sensors.items() if n in sensors}
    built = BuiltRun(
        scenario=world, name=name, robot=robot, parts=parts, model=model, task=task,
        sensors=made, infos={n: sensor.info() for n, sensor in made.items()},
        visible=tuple(n for n in (sensors if visible is None else visible) if n in made),
    )  # fmt: skip
    host.reset(task, built.infos, seed)
    own = RunRobot(built=built, host=host, log=log, ending=RobotEnding())
    blocks = build_diagram([own], engine, log, seed=seed, tick=tick)
    simulator: Any = Simulator(blocks.diagram)
    context = simulator.get_mutable_context()
    blocks.robots[0].base.place(context, task.start)
    if initialize:  # publishes t = 0
        simulator.Initialize()
    return Rig(blocks, simulator, memory, log)


class _Straight:
    contact_stiffness = 0.0

    def accelerations(self, view: CrowdView) -> Array:
        return np.zeros_like(view.position)


def person(
    x: float, y: float = 0.0, speed: float = 1.2, *, stiffness: float = 30000.0
) -> CrowdEngine:
    """One person who walks straight in -x along y = 0, come what may."""
    agents = Agents.of(
        id=np.zeros(1, np.int64), x=np.array([x]), y=np.array([y]),
        preferred_speed=np.array([speed]), radius=np.array([0.33]), max_speed=np.array([3.0]),
        max_acceleration=np.array([5.0]), mass=np.array([75.0]), ignores_robot=np.array([True]),
    )  # fmt: skip
    world = CrowdWorld(
        walls=np.zeros((0, 4)), entrance=np.array([50.0, 51.0, -5.0, 5.0]),
        out=np.array([-1.0, 0.0, y - 0.33, y + 0.33]),
        robot_visible=True, stiffness=stiffness, dissipation=0.3, goal_key=1, decision_rate=16.0,
    )  # fmt: skip
    return CrowdEngine(agents, world, lambda _: _Straight())


def rows(flat: Array) -> Array:
    return s.view(flat)[1]


def wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)
