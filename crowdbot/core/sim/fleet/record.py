"""Record one run of several robots to one file, with or without people."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from pydrake.systems.analysis import Simulator

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.geometry.polygon import distance_to
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.runs.outcome import (
    ARRIVED,
    INTERRUPTED,
    PLANNER_FAILED,
    TIMEOUT,
    TOPPLED,
    Outcome,
    Progress,
)
from crowdbot.core.sim import ports
from crowdbot.core.sim.bodies import outlines_of, rows_of
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.fate import Fate
from crowdbot.core.sim.fleet.diagram import FleetBlocks, FleetRobot, build_fleet
from crowdbot.core.sim.outline_overlap import overlap_of_robots
from crowdbot.core.sim.record import description_of, header_of, hosted, watchdog_of
from crowdbot.core.sim.run_setup import RunSetup, agents, aim_of, choosers, ids
from crowdbot.core.sim.runner import LOOK, has_ended
from crowdbot.core.sim.start_pose_check import check_start
from crowdbot.core.types.robot import HolonomicDrive
from crowdbot.errors import InputError


def record_fleet(setup: RunSetup, builts: Mapping[str, BuiltRun]) -> Outcome:
    """Simulate the scenario's robots, each with its planner, and its people.

    Args:
        setup: setup of the recording.
        builts: from `build_run`, of all robots of the scenario; not reusable.

    Raises:
        InputError: a robot would start in a wall, an obstacle, a person or another robot.
        PlannerHungError: a planner step never returned; the recording is closed anyway.
    """
    first = next(iter(builts.values()))
    engine = build_crowd(first.scenario, setup.agents, first.parts, setup.registry)
    for name, built in builts.items():
        check_start(built.parts, built.model, built.task.start, engine, name)
    _check_apart(builts)
    shared = RecordingHeader(
        scenario=first.scenario.id, hashes=setup.hashes, agents=agents(engine),
        walls=first.parts.walls,
    )  # fmt: skip
    fates = {n: Fate(leaves=b.robot.task.when_ended == "leave") for n, b in builts.items()}
    with contextlib.ExitStack() as stack:
        root = RecordingWriter(
            setup.recording, shared, record=setup.options.record, choosers=choosers(engine)
        )
        stack.callback(_close, root, fates)
        fleet = [
            _member(setup, built, engine, root, fates[name], k, stack)
            for k, (name, built) in enumerate(builts.items())
        ]
        log = RunLog(root, ids(engine), robot=None, aim=aim_of(engine))
        if engine is not None:
            _compile(engine, builts)
        return _run(setup, fleet, build_fleet(fleet, engine, log, seed=setup.seed))


def _compile(engine: CrowdEngine, builts: Mapping[str, BuiltRun]) -> None:
    """Compile kernels before the clock starts."""
    models = [built.model for built in builts.values()]
    engine.advance(
        engine.initial_state(len(models)), rows_of(models), outlines_of(models),
    )  # fmt: skip


def _member(
    setup: RunSetup,
    built: BuiltRun,
    engine: CrowdEngine | None,
    root: RecordingWriter,
    fate: Fate,
    number: int,
    stack: contextlib.ExitStack,
) -> FleetRobot:
    """Build one robot with its part of the recording and its planner."""
    choice = setup.choice.of(built.name)
    header = replace(header_of(built, None), hashes=setup.hashes, namespace=built.name)
    writer = RecordingWriter(
        setup.recording,
        header,
        record=setup.options.record,
        beside=root,
        description=description_of(setup, built),
    )
    # Before the root is closed, which was registered earlier.
    stack.callback(_close_member, writer, fate)
    sideways = isinstance(built.model.drive, HolonomicDrive)
    own = replace(setup, choice=choice)
    watchdog = stack.enter_context(watchdog_of(own))
    return FleetRobot(
        built=built,
        host=stack.enter_context(hosted(own, built, watchdog)),
        log=RunLog(writer, ids(engine), sideways=sideways, people=False, robot=number),
        fate=fate,
        privileged=choice.privileged,
    )


def _close_member(writer: RecordingWriter, fate: Fate) -> None:
    status = fate.status or INTERRUPTED
    until = fate.until if fate.ended else None
    writer.close(fate.goal_time, fate.ended, status, until)


def _close(writer: RecordingWriter, fates: Mapping[str, Fate]) -> None:
    goal_time = _last_arrival(fates)
    writer.close(goal_time, all(f.ended for f in fates.values()), _status(fates))


def _run(setup: RunSetup, fleet: Sequence[FleetRobot], blocks: FleetBlocks) -> Outcome:
    """Simulate; afterwards everything is in the logs, even after an error."""
    simulator = Simulator(blocks.diagram)
    context = simulator.get_mutable_context()
    for robot, one in zip(blocks.robots, fleet, strict=True):
        robot.place(context, one.built.task.start)
    begin, cpu = time.perf_counter(), time.process_time()
    fates = {one.built.name: one.fate for one in fleet}
    interrupted = False
    try:
        ended = has_ended(simulator.Initialize())
        while not ended and not interrupted:
            interrupted = setup.stop()
            if interrupted:
                break
            ended = has_ended(simulator.AdvanceTo(context.get_time() + LOOK))
            if setup.progress is not None:
                t = float(context.get_time())
                factor = t / max(time.perf_counter() - begin, 1e-9)
                far = _farthest(fleet, blocks, context)
                limit = max(one.built.task.time_limit for one in fleet)
                setup.progress(Progress(setup.stage, t, limit, factor, far))
    finally:
        _finish(fleet, blocks, context)
    steps = [one.log.step_times() for one in fleet]
    return Outcome(
        status=_status(fates),
        reason="interrupted by the user" if interrupted else _reason(fates),
        goal_time=_last_arrival(fates),
        sim_time=float(context.get_time()),
        wall_time=time.perf_counter() - begin,
        cpu_time=time.process_time() - cpu,
        clamped=sum(one.log.clamped for one in fleet),
        planner_step_time={
            "mean": round(float(np.mean([step["mean"] for step in steps])), 6),
            "max": max(step["max"] for step in steps),
        },
        robots={one.built.name: _outcome(one) for one in fleet},
    )


def _outcome(one: FleetRobot) -> Outcome:
    """Return the outcome of one robot; machine times are those of the run."""
    fate = one.fate
    return Outcome(
        status=fate.status or INTERRUPTED,
        reason=fate.reason or "interrupted by the user",
        goal_time=fate.goal_time,
        toppled_time=fate.toppled_time,
        sim_time=fate.until,
        wall_time=0.0,
        cpu_time=0.0,
        clamped=one.log.clamped,
        planner_step_time=one.log.step_times(),
    )


def _finish(fleet: Sequence[FleetRobot], blocks: FleetBlocks, context: object) -> None:
    """Write active trips and contacts at the end."""
    t = float(context.get_time())  # type: ignore[attr-defined]
    blocks.contacts.finish()
    for one, logger in zip(fleet, blocks.loggers, strict=True):
        if not one.fate.ended:
            logger.finish(logger.GetMyContextFromRoot(context), t)
    blocks.people.finish(blocks.people.GetMyContextFromRoot(context), t)


def _farthest(fleet: Sequence[FleetRobot], blocks: FleetBlocks, context: object) -> float:
    """Return the largest goal distance of active robots, m."""
    found = [0.0]
    for one, robot in zip(fleet, blocks.robots, strict=True):
        if not one.fate.ended:
            mine = robot.state.GetMyContextFromRoot(context)
            x, y, *_ = robot.state.GetOutputPort(ports.ROBOT_STATE).Eval(mine)
            found.append(distance_to(one.built.task.goal_zone, x, y))
    return max(found)


def _status(fates: Mapping[str, Fate]) -> str:
    """Return the status of the run: the first of these that a robot has; arrived if all did."""
    found = [fate.status or INTERRUPTED for fate in fates.values()]
    for status in (INTERRUPTED, PLANNER_FAILED, TOPPLED, TIMEOUT):
        if status in found:
            return status
    return ARRIVED


def _reason(fates: Mapping[str, Fate]) -> str:
    return "; ".join(f"{name}: {fate.reason}" for name, fate in fates.items())


def _last_arrival(fates: Mapping[str, Fate]) -> float | None:
    """Return the arrival time of the last robot, s; None if one did not arrive."""
    times = [fate.goal_time for fate in fates.values()]
    known = [t for t in times if t is not None]
    return max(known) if len(known) == len(times) else None


def _check_apart(builts: Mapping[str, BuiltRun]) -> None:
    """Refuse robots that would start in each other.

    Raises:
        InputError: two do.
    """
    models = [built.model for built in builts.values()]
    rows = rows_of(models)
    for row, built in zip(rows, builts.values(), strict=True):
        row[0], row[1], row[6] = built.task.start
    corners = [footprint_of_model(model).corners for model in models]
    names = list(builts)
    for i, j in combinations(range(len(names)), 2):
        if overlap_of_robots(rows[i], corners[i], rows[j], corners[j])[0] > 1e-6:
            raise InputError(
                f"robots '{names[i]}' and '{names[j]}' would start in each other; move task.start"
            )
