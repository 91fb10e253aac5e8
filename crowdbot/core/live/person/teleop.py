"""Runs in which a person drives a robot with a stick: ordinary runs with a special joystick."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from crowdbot.core.live.live_record import with_live_part
from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.person.pass_through import StickPlanner
from crowdbot.core.live.person.seat import Seat, SeatLog
from crowdbot.core.live.person.seat_stick import JOYSTICK, SeatStick, with_stick
from crowdbot.core.live.session import LiveSession
from crowdbot.core.planning.choice import PlannerChoice
from crowdbot.core.planning.given_planner import choose_planner
from crowdbot.core.planning.planner import Planner
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.identity import prepare
from crowdbot.core.runs.record_parts import LatencyPart, LivePart, StopPart, WaitPart
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.sensing.sensor import Sensor
from crowdbot.core.sim.built_run import BuiltRun, build_run, build_runs
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

#: Makes the sensor of a stick from the robot's limits and the sensor's description.
StickMaker = Callable[[RobotLimits, SensorInfo], Sensor]


@dataclass(frozen=True, kw_only=True)
class Controls:
    """The robots of a run, and their drivers.

    Attributes:
        robot: the robot with the person's stick.
        assist: planner that shares control with the person; None: the person drives alone.
        others: planner of each other robot, by name.
        name: of the planner in the record; default: ``teleop``, and the assistant's.
    """

    robot: str
    assist: PlannerChoice | None = None
    others: Mapping[str, PlannerChoice]
    name: str = ""


def controls_of(
    scenario: Scenario,
    registry: Registry,
    *,
    robot: str | None = None,
    assist: str | None = None,
    settings: Sequence[str] = (),
    others: Mapping[str, str] | None = None,
    name: str = "",
) -> Controls:
    """Return which robot of a scenario the person drives, and the planners of the others.

    Args:
        robot: with the stick; default: the first.
        assist: planner that reads ``joystick``, with its ``settings``.
        others: planners of other robots, by name; default: dwa.

    Raises:
        InputError: there is no such robot, or a planner is wrong.
        UnknownNameError: no planner of that kind is installed.
    """
    names, given = tuple(scenario.robots), dict(others or {})
    if not names:
        raise InputError(f"{scenario.id} has no robot, and 'crowdbot teleop' drives one")
    driven = names[0] if robot is None else robot
    for robot_name in (driven, *given):
        if robot_name not in names:
            raise InputError(f"{scenario.id} has no robot '{robot_name}', but {', '.join(names)}")
    if driven in given:
        raise InputError(f"robot '{driven}' has a person at its stick, and no planner of its own")
    chosen = None if assist is None else choose_planner(assist, registry, settings)
    if chosen is not None and chosen.needs is not None and JOYSTICK not in chosen.needs:
        raise InputError(f"planner '{assist}' reads no joystick, so it shares control with no one")
    return Controls(
        robot=driven,
        assist=chosen,
        others={n: choose_planner(given.get(n, "dwa"), registry) for n in names if n != driven},
        name=name or ("teleop" if chosen is None else f"teleop-{chosen.label}"),
    )


def choice_of(
    controls: Controls, scenario: Scenario, stick: str, lidars: Sequence[str]
) -> PlannerChoice:
    """Return the planner of the driven robot: the person alone, or with an assistant.

    Args:
        stick: name of the sensor that is the stick.
        lidars: sensors that the page shows, where no assistant chooses.
    """
    name, assist = controls.name, controls.assist
    if not name or name.startswith(".") or set(name) & set("/\\\0"):
        raise InputError(f"'{name}' cannot be the name of a planner, which a folder has")
    build: Callable[[], Planner] = partial(StickPlanner, stick) if assist is None else assist.build
    needs: tuple[str, ...] | None = tuple(lidars)
    if assist is not None:
        needs = None if assist.needs is None else tuple(n for n in assist.needs if n != JOYSTICK)
    spec = {"kind": "teleop"} if assist is None else {"kind": "teleop", "assist": assist.spec_dump}
    person = PlannerChoice(
        name=name,
        spec_dump=spec,
        build=build,
        pinned=assist is not None and assist.pinned,
        needs=needs,
        label=name,
        privileged=assist is not None and assist.privileged,
        origin="a person in a page",
        in_process=assist is None or assist.in_process,
        memory=None if assist is None else assist.memory,
        repeatable=False,
        patience=math.inf if assist is None else assist.patience,
    )
    if len(scenario.robots) < 2:
        return person
    return replace(person, fleet={**controls.others, controls.robot: person})


def built_with_stick(
    request: Request, controls: Controls, make: StickMaker
) -> tuple[Request, dict[str, BuiltRun]]:
    """Return the request with built planners, and the runs of all robots, one with a stick."""
    scenario, registry = request.scenario, request.registry
    bare = replace(request.choice, needs=(), fleet={})
    every = build_run(scenario, registry, bare, "all", controls.robot)
    own = (n for n, info in every.infos.items() if info.category == "joystick")
    lidars = [n for n, info in every.infos.items() if info.category == "lidar"]
    choice = choice_of(controls, scenario, next(own, JOYSTICK), lidars)
    request = replace(request, choice=choice, options=replace(request.options, force=True))
    builts = build_runs(scenario, registry, choice, request.options.record)
    driven = builts[controls.robot]
    sideways = controls.assist is None
    return request, {**builts, controls.robot: with_stick(driven, make, sideways=sideways)}


def seat_at(robot: str, interrupted: Callable[[], bool], rate: float = 1.0) -> Seat:
    """Return the seat of a robot with a session of its own."""
    session = LiveSession(interrupted=interrupted, robots={"": LiveRobot(name=robot)})
    return Seat(session, rate=rate)


def drive(request: Request, builts: Mapping[str, BuiltRun], seat: Seat, robot: str) -> Run:
    """Make the run with the person; the calibration run of people alone is simulated before.

    Raises:
        Interrupted: the user stopped the run; a ``.partial`` directory is left.
    """
    from crowdbot.core.sim.simulate import make_run

    session = seat.session
    prepared = prepare(request.scenario, request.registry, references=request.options.references)
    # A robot alone would need the person to drive once more.
    prepared = replace(prepared, alone=None)
    session.begin(request.scenario.id, request.seed, (robot,))
    session.robots[""].limits = builts[robot].model.limits
    run = make_run(replace(request, stop=lambda: session.must_stop), prepared, builts=builts)
    return with_live_part(run, live_part(seat.log, session.counts.refused))


def repeat(request: Request, builts: Mapping[str, BuiltRun]) -> Run:
    """Repeat the run with recorded stick commands, without a person."""
    from crowdbot.core.sim.simulate import make_run

    prepared = prepare(request.scenario, request.registry, references=request.options.references)
    return make_run(request, replace(prepared, alone=None), builts=builts)


def live_part(log: SeatLog, refused: int) -> LivePart:
    """Return the live part of a record: the events of the person who drives."""
    live = LivePart(
        steps=log.steps,
        missed_steps=log.centred,
        refused_commands=refused,
        stops=[StopPart(t=t, why=why) for t, why in log.stops],
        waits=[WaitPart(t=t, seconds=round(s, 3), why=why) for t, s, why in log.waits],
        delayed=round(log.delayed, 3),
    )
    return live.model_copy(update={"latency": _latency(log.latencies)}) if log.latencies else live


def _latency(times: Sequence[float]) -> LatencyPart:
    return LatencyPart(
        count=len(times),
        median=round(statistics.median(times), 2),
        p95=round(float(np.percentile(times, 95)), 2),
    )


def seat_stick(seat: Seat) -> StickMaker:
    """Return a factory for the stick of a person's place."""
    return lambda limits, info: SeatStick(seat, limits, info)
