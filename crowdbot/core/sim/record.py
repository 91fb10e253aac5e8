"""Records one run of a robot into one file: among people, or alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import cast

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
from crowdbot.core.recording import RecordingHeader, RobotHeader
from crowdbot.core.robots import build_robot
from crowdbot.core.run_log import RunLog
from crowdbot.core.sensing.guard import build_sensor
from crowdbot.core.sim.diagram import build_diagram, robot_task
from crowdbot.core.sim.outcome import Outcome
from crowdbot.core.sim.record_crowd import RunSetup, agents, ids, recording
from crowdbot.core.sim.runner import run
from crowdbot.core.sim.start_check import check_start
from crowdbot.core.urdf import check_frames
from crowdbot.core.watchdog import Watchdog
from crowdbot.dsl.seeds import stream_seed
from crowdbot.errors import PlannerError, PlannerHungError


def record_robot(setup: RunSetup) -> Outcome:
    """Simulate the scenario's robot with the planner; people too if the scenario has any.

    Raises:
        InputError: the robot would start in a wall, an obstacle or a person, or a sensor has the
            name of a frame that is not its own.
        PlannerHungError: a planner step never returned; the recording is closed all the same.
    """
    scenario, registry = setup.scenario, setup.registry
    ((name, robot),) = scenario.robots.items()
    parts = build_environment(registry, scenario.environment)
    model = build_robot(registry, robot)
    engine = build_crowd(scenario, setup.agents, parts, registry)
    infos = {n: _framed(n, build_sensor(registry, x).info()) for n, x in robot.sensors.items()}
    check_frames(model, infos)
    choice = setup.choice
    visible = select_sensors(choice.needs, infos, choice.name, privileged=choice.privileged)
    sensors = set(infos) if setup.record == "all" else {*visible, *_odometry(infos)}
    task = robot_task(robot, parts)
    check_start(parts, model, task.start, engine, name)
    header = RecordingHeader(
        scenario=scenario.id,
        robot=RobotHeader(
            radius=model.footprint_radius,
            mass=model.mass,
            goal=task.goal,
            base_height=model.base_height,
            limits=model.limits,
            footprint=model.footprint,
        ),
        agents=agents(engine),
        sensors={n: i for n, i in infos.items() if n in sensors},
        walls=parts.walls,
        goal_zone=task.goal_zone,
    )
    with recording(setup, header) as (writer, ending), _watchdog(setup) as watchdog:
        sideways = isinstance(model.drive, HolonomicDrive)
        log = RunLog(writer, ids(engine), sideways=sideways)
        seen = {n: infos[n] for n in visible}
        host = _host(setup, model, task, seen, watchdog, name)
        if engine is not None:
            engine.advance(engine.initial_state())  # compiles kernels before the clock starts
        blocks = build_diagram(
            scenario, name, parts, model, engine, host, log, registry,
            run_seed=setup.seed, sensors=sensors, visible=visible,
            privileged=choice.privileged,
        )  # fmt: skip
        outcome = run(
            blocks, task, log, stage=setup.stage, progress=setup.progress, stop=setup.stop
        )
        ending.append(outcome)
    return outcome


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
        host = PlannerHost(
            planner, choice.name, model.limits,
            budget=setup.step_budget, watchdog=watchdog, origin=choice.origin,
        )  # fmt: skip
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
