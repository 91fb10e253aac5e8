"""Records one run of a scenario's robots into one file: among people, or alone."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any, cast

from crowdbot.core.planning.choice import PlannerChoice
from crowdbot.core.planning.half import PlannerWithHalf
from crowdbot.core.planning.host import RESET_LIMIT, HostedCommand, PlannerHost
from crowdbot.core.planning.planner import Observation, Planner
from crowdbot.core.planning.process.process_planner import ProcessPlanner
from crowdbot.core.planning.watchdog import Watchdog
from crowdbot.core.runs.outcome import Outcome
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.contacts.start_pose_check import check_starts
from crowdbot.core.sim.diagram import Blocks, RunRobot, build_diagram
from crowdbot.core.sim.drake_failures import drake_failures
from crowdbot.core.sim.loggers.run_logs import run_logs
from crowdbot.core.sim.person_targets import with_targets
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.sim.run_setup import RunSetup
from crowdbot.core.sim.runner import run
from crowdbot.core.support.compile_cache import compiled
from crowdbot.core.types.robot import RobotLimits
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import PlannerError, PlannerHungError


@drake_failures()
def record_robots(
    setup: RunSetup,
    builts: Mapping[str, BuiltRun],
    hosts: Mapping[str, PlannerHost] | None = None,
) -> Outcome:
    """Simulate the scenario's robots, each with its planner; people too if there are any.

    Args:
        setup: what to record, and where.
        builts: from `build_runs`, of all robots of the scenario; used up by this.
        hosts: of planners that have been reset, by robot; None builds those that ``setup`` chose.

    Raises:
        InputError: a robot would start in a wall, an obstacle, a person or another robot, or the
            person of its task is not there.
        PlannerHungError: a planner step never returned; the recording is closed all the same.
    """
    builts = with_targets(builts, setup.agents)
    first = next(iter(builts.values()))
    engine = build_crowd(first.scenario, setup.agents, first.parts, setup.registry)
    check_starts(builts, engine)
    endings = {
        name: RobotEnding(leaves=built.robot.task.when_ended == "leave")
        for name, built in builts.items()
    }
    with run_logs(setup, builts, engine, endings) as logs, contextlib.ExitStack() as stack:
        robots = [
            RunRobot(
                built=built,
                host=hosts[name] if hosts else stack.enter_context(_hosted(setup, built)),
                log=logs.robots[name],
                ending=endings[name],
                privileged=setup.choice.of(name).privileged,
            )
            for name, built in builts.items()
        ]
        if engine is not None:
            engine.advance(engine.initial_state())  # compiles kernels before the clock starts
            if setup.on_crowd is not None:
                setup.on_crowd(engine, logs.people.writer.signal)
        blocks = build_diagram(robots, engine, logs.people, seed=setup.seed)
        outcome = run(
            blocks, stage=setup.stage, progress=setup.progress, stop=setup.stop,
            on_begin=lambda root: setup.on_begin and setup.on_begin(partial(_seen, blocks, root)),
        )  # fmt: skip
    return replace(outcome, written=logs.people.writer.written)


def _seen(blocks: Blocks, root: Any) -> dict[str, Observation]:
    """Return the observations of all robots that have not ended, from the diagram's context."""
    found = {robot.given.built.name: robot.planner.observation(root) for robot in blocks.robots}
    return {name: obs for name, obs in found.items() if obs is not None}


@contextmanager
def _hosted(setup: RunSetup, built: BuiltRun) -> Iterator[PlannerHost]:
    """Return the host of a robot's planner, with a watchdog."""
    own = replace(setup, choice=setup.choice.of(built.name))
    with watchdog_of(own) as watchdog, hosted(own, built, watchdog) as host:
        yield host


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
        if isinstance(planner, ProcessPlanner | PlannerWithHalf):
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
