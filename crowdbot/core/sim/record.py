"""Records one run into one file: a robot among people, a robot alone, or people alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd_run import run_crowd
from crowdbot.core.crowd_setup import build_crowd
from crowdbot.core.environments import build_environment
from crowdbot.core.interfaces import (
    HolonomicDrive,
    Observation,
    Planner,
    RobotLimits,
    RobotModel,
    SensorInfo,
    Task,
)
from crowdbot.core.planner_host import RESET_LIMIT, HostedCommand, PlannerHost
from crowdbot.core.planner_source import PlannerChoice, select_sensors
from crowdbot.core.realisation import Realisation
from crowdbot.core.recording import AgentsHeader, RecordingHeader, RecordingWriter, RobotHeader
from crowdbot.core.registry import Registry
from crowdbot.core.robots import build_robot
from crowdbot.core.run_log import RunLog
from crowdbot.core.sensing.guard import build_sensor
from crowdbot.core.sim.diagram import build_diagram, robot_task
from crowdbot.core.sim.runner import INTERRUPTED, TIMEOUT, Outcome, Progress, run
from crowdbot.core.watchdog import Watchdog
from crowdbot.dsl.scenario import Scenario
from crowdbot.dsl.seeds import stream_seed
from crowdbot.errors import InputError, PlannerError, PlannerHungError


@dataclass(frozen=True, slots=True, kw_only=True)
class RunSetup:
    """What one recording needs."""

    scenario: Scenario
    agents: Realisation
    registry: Registry
    choice: PlannerChoice
    seed: int
    recording: Path
    record: Literal["all", "used", "none"]
    stage: str
    progress: Callable[[Progress], None] | None
    stop: Callable[[], bool]
    on_hang: Callable[[], object] | None


def record_robot(setup: RunSetup) -> Outcome:
    """Simulate the scenario's robot with the planner; people too if the scenario has any.

    Raises:
        PlannerHungError: a planner step never returned; the recording is closed all the same.
    """
    scenario, registry = setup.scenario, setup.registry
    ((name, robot),) = scenario.robots.items()
    parts = build_environment(registry, scenario.environment)
    model = build_robot(registry, robot)
    engine = build_crowd(scenario, setup.agents, parts, registry)
    infos = {n: _framed(n, build_sensor(registry, x).info()) for n, x in robot.sensors.items()}
    choice = setup.choice
    visible = select_sensors(choice.needs, infos, choice.name, privileged=choice.privileged)
    sensors = set(infos) if setup.record == "all" else {*visible, *_odometry(infos)}
    task = robot_task(robot, parts)
    header = RecordingHeader(
        scenario=scenario.id,
        robot=RobotHeader(
            radius=model.footprint_radius,
            mass=model.mass,
            goal=task.goal,
            base_height=model.base_height,
            limits=model.limits,
        ),
        agents=_agents(engine),
        sensors={n: i for n, i in infos.items() if n in sensors},
        walls=parts.walls,
        goal_zone=task.goal_zone,
    )
    with _recording(setup, header) as (writer, ending), _watchdog(setup) as watchdog:
        sideways = isinstance(model.drive, HolonomicDrive)
        log = RunLog(writer, _ids(engine), sideways=sideways)
        seen = {n: infos[n] for n in visible}
        host = _host(setup, model, task, seen, watchdog, name)
        if engine is not None:
            engine.advance(engine.initial_state())  # compiles kernels before the clock starts
        blocks = build_diagram(
            scenario, name, parts, model, engine, host, log, registry,
            run_seed=setup.seed, sensors=sensors, visible=visible,
        )  # fmt: skip
        outcome = run(
            blocks, task, log, stage=setup.stage, progress=setup.progress, stop=setup.stop
        )
        ending.append(outcome)
    return outcome


def record_crowd(setup: RunSetup, duration: float) -> Outcome:
    """Simulate the scenario's people without a robot, and without Drake."""
    scenario, registry = setup.scenario, setup.registry
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, setup.agents, parts, registry)
    if engine is None:
        raise InputError(f"{scenario.id} has no crowd")
    header = RecordingHeader(scenario=scenario.id, agents=_agents(engine), walls=parts.walls)
    begin, cpu = time.perf_counter(), time.process_time()
    now = 0.0

    def report(t: float) -> None:
        nonlocal now
        now = t
        if setup.progress is not None and t == int(t):
            factor = t / max(time.perf_counter() - begin, 1e-9)
            setup.progress(Progress(setup.stage, t, duration, factor, None))

    with _recording(setup, header) as (writer, ending):
        log = RunLog(writer, _ids(engine))
        whole = run_crowd(
            engine, log, duration, scenario.rates.log, on_sample=report, stop=setup.stop
        )
        outcome = Outcome(
            status=TIMEOUT if whole else INTERRUPTED,
            reason=f"ran for {duration:g} s" if whole else "interrupted by the user",
            goal_time=None,
            sim_time=now,
            wall_time=time.perf_counter() - begin,
            cpu_time=time.process_time() - cpu,
        )
        ending.append(outcome)
    return outcome


@contextmanager
def _recording(
    setup: RunSetup, header: RecordingHeader
) -> Iterator[tuple[RecordingWriter, list[Outcome]]]:
    """A writer that is closed whatever happens; the body appends how the run ended."""
    writer = RecordingWriter(setup.recording, header, record=setup.record)
    ending: list[Outcome] = []
    try:
        yield writer, ending
    finally:
        last = ending[0] if ending else None
        status = last.status if last else INTERRUPTED
        goal_time = last.goal_time if last else None
        writer.close(goal_time, status != INTERRUPTED, status)


@contextmanager
def _watchdog(setup: RunSetup) -> Iterator[Watchdog]:
    watchdog = Watchdog(on_hang=setup.on_hang)
    try:
        yield watchdog
    finally:
        watchdog.close()


def _host(
    setup: RunSetup,
    model: RobotModel,
    task: Task,
    sensors: Mapping[str, SensorInfo],
    watchdog: Watchdog,
    robot: str,
) -> PlannerHost:
    """The planner, built and reset; one that fails in this fails again in its first step."""
    choice = setup.choice
    try:
        planner = _build(choice, watchdog)
        host = PlannerHost(planner, choice.name, model.limits, watchdog=watchdog)
        # Halved, so that planners may hand the seed to generators of signed integers.
        host.reset(task, sensors, stream_seed(setup.seed, robot, "planner") >> 1)
    except PlannerError as error:
        return _FailedHost(error, choice.name, model.limits)
    return host


def _build(choice: PlannerChoice, watchdog: Watchdog) -> Planner:
    """The planner itself; its constructor may load models, but not for ever."""
    try:
        with watchdog.patience(RESET_LIMIT), watchdog:
            return choice.build()
    except PlannerHungError:
        text = f"planner '{choice.name}' could not be made within {RESET_LIMIT:g} s"
        raise PlannerHungError(text) from None


class _FailedHost(PlannerHost):
    """Stands for a planner that did not survive its reset: the run ends at its first step."""

    def __init__(self, error: PlannerError, name: str, limits: RobotLimits) -> None:
        super().__init__(cast(Planner, None), name, limits)
        self._error = error

    def step(self, obs: Observation) -> HostedCommand:
        """Raise what the planner raised."""
        del obs
        raise self._error


def _framed(name: str, info: SensorInfo) -> SensorInfo:
    """A sensor does not know its own name; its frame is called by it."""
    return info if info.category == "odometry" else replace(info, frame=name)


def _odometry(infos: Mapping[str, SensorInfo]) -> set[str]:
    return {n for n, i in infos.items() if i.category == "odometry"}


def _ids(engine: CrowdEngine | None) -> NDArray[np.int64]:
    return np.zeros(0, np.int64) if engine is None else engine.agents.id


def _agents(engine: CrowdEngine | None) -> AgentsHeader | None:
    if engine is None:
        return None
    a = engine.agents
    return AgentsHeader(id=a.id, radius=a.radius, mass=a.mass)
