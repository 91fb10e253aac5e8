"""Record one run of a robot to one file, with or without people."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import cast

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.planning.host import RESET_LIMIT, HostedCommand, PlannerHost
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.planning.process.process_planner import ProcessPlanner
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.core.recording.header import RecordingHeader, RobotHeader
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.robots.urdf_export import to_urdf
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.diagram import build_diagram
from crowdbot.core.sim.run_setup import RunSetup, agents, aim_of, ids, recording
from crowdbot.core.sim.runner import run
from crowdbot.core.sim.start_pose_check import check_start
from crowdbot.core.support.compile_cache import compiled
from crowdbot.core.types.robot import HolonomicDrive, RobotLimits
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import PlannerError, PlannerHungError


def record_robot(setup: RunSetup, built: BuiltRun, host: PlannerHost | None = None) -> Outcome:
    """Simulate the scenario's robot with the planner, and its people if any.

    Args:
        setup: setup of the recording.
        built: from `build_run`, of the same scenario; not reusable.
        host: host of a planner that has been reset; None: the planner in ``setup``.

    Raises:
        InputError: the robot would start in a wall, an obstacle or a person.
        PlannerHungError: a planner step never returned; the recording is closed anyway.
    """
    engine = build_crowd(built.scenario, setup.agents, built.parts, setup.registry)
    check_start(built.parts, built.model, built.task.start, engine, built.name)
    header = replace(header_of(built, engine), hashes=setup.hashes)
    for watcher in setup.watchers:
        watcher.begin(header)
    with (
        recording(setup, header, engine, description_of(setup, built)) as (writer, ending),
        watchdog_of(setup) as watchdog,
        contextlib.ExitStack() as stack,
    ):
        sideways = isinstance(built.model.drive, HolonomicDrive)
        log = RunLog(
            writer, ids(engine), sideways=sideways, watchers=setup.watchers, aim=aim_of(engine)
        )
        host = host or stack.enter_context(hosted(setup, built, watchdog))
        if engine is not None:
            engine.advance(engine.initial_state())  # compiles kernels before the clock starts
        blocks = build_diagram(
            built, engine, host, log, seed=setup.seed, privileged=setup.choice.privileged
        )
        outcome = run(
            blocks, built.task, log, stage=setup.stage, progress=setup.progress, stop=setup.stop
        )
        ending.append(outcome)
    return outcome


def header_of(built: BuiltRun, engine: CrowdEngine | None) -> RecordingHeader:
    """Return the constants of a robot's run."""
    model, task = built.model, built.task
    return RecordingHeader(
        scenario=built.scenario.id,
        robot=RobotHeader(
            radius=model.footprint_radius,
            mass=model.mass,
            goal=task.goal,
            base_height=model.base_height,
            limits=model.limits,
            footprint=model.footprint,
        ),
        agents=agents(engine),
        sensors=built.infos,
        walls=built.parts.walls[built.parts.wall_heights[:, 0] < model.height],
        goal_zone=task.goal_zone,
    )


def description_of(setup: RunSetup, built: BuiltRun) -> str:
    """The robot's URDF, where it is recorded."""
    return to_urdf(built.model, built.infos, built.name) if setup.options.record != "none" else ""


@contextmanager
def watchdog_of(setup: RunSetup) -> Iterator[Watchdog | None]:
    """Yield a watchdog for a planner in this process.

    One in a separate process is simply killed.
    """
    if not setup.choice.in_process:
        yield None
        return
    patience = setup.choice.patience
    limit = {} if patience is None else {"limit": patience}
    watchdog = Watchdog(on_hang=setup.on_hang, **limit)
    try:
        yield watchdog
    finally:
        watchdog.close()


@contextmanager
def hosted(setup: RunSetup, built: BuiltRun, watchdog: Watchdog | None) -> Iterator[PlannerHost]:
    """Yield the host of a planner, built and reset; if that fails, its first step fails again.

    A separate process is ended afterwards.
    """
    choice, limits = setup.choice, built.model.limits
    sensors = {n: built.infos[n] for n in built.visible}
    planner: Planner | None = None
    host: PlannerHost
    try:
        planner = _build(choice, watchdog)
        host = PlannerHost(
            planner, choice.name, limits,
            budget=setup.options.step_budget, watchdog=watchdog, origin=choice.origin,
            copies=not isinstance(planner, ProcessPlanner),
        )  # fmt: skip
        # Halved, so that planners can use the seed in generators of signed integers.
        host.reset(built.task, sensors, stream_seed(setup.seed, built.name, "planner") >> 1)
    except PlannerError as error:
        host = _FailedHost(error, choice.name, limits)
    try:
        yield host
    finally:
        if isinstance(planner, ProcessPlanner):
            planner.close()


def _build(choice: PlannerChoice, watchdog: Watchdog | None) -> Planner:
    """Build the planner; its constructor may load models, within a time limit."""
    if watchdog is None:
        return choice.build()
    try:
        with watchdog.patience(RESET_LIMIT, compiled), watchdog:
            return choice.build()
    except PlannerHungError:
        text = f"planner '{choice.name}' could not be made within {RESET_LIMIT:g} s"
        raise PlannerHungError(text) from None


class _FailedHost(PlannerHost):
    """Host of a planner that failed in its reset: the run ends at its first step."""

    def __init__(self, error: PlannerError, name: str, limits: RobotLimits) -> None:
        super().__init__(cast(Planner, None), name, limits)
        self._error = error

    def step(self, obs: Observation) -> HostedCommand:
        """Raise the planner's error."""
        del obs
        raise self._error
