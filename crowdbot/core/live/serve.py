"""Serve live runs: ordinary runs whose planner listens to external programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import partial

from crowdbot.core.live.live_connection import LiveConnection
from crowdbot.core.live.live_record import with_live_part
from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.planner import LivePlanner
from crowdbot.core.live.robot_topics import namespaces
from crowdbot.core.live.scene import LiveScene
from crowdbot.core.live.session import LiveSession, State
from crowdbot.core.live.step_policy import StepPolicy
from crowdbot.core.live.steps import LiveSteps, status
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.recording.watcher import Watcher
from crowdbot.core.runs.identity import prepare
from crowdbot.core.runs.record_parts import LivePart
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.types.ending import Ending
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError, Interrupted

_SWITCH = 0.0005  # s


@dataclass(frozen=True, kw_only=True)
class LiveServe:
    """The configuration of a live server.

    Attributes:
        scenarios: scenarios in order; ``first`` is the initial one.
        request: function that builds the request for a scenario from planner and seed.
        stay: True to wait for clients' requests after a complete run.
        watchers: viewers of the ground truth.
        on_run: callback for each complete run.
    """

    session: LiveSession
    connections: Sequence[LiveConnection]
    policy: StepPolicy
    scenarios: Sequence[Scenario]
    request: Callable[[Scenario, PlannerChoice, int], Request]
    name: str = "live"
    first: int = 0
    seed: int = 0
    stay: bool = False
    watchers: Sequence[Watcher] = ()
    on_run: Callable[[Run], object] = lambda _: None


def serve_runs(service: LiveServe) -> Run:
    """Serve runs until one is complete, or with ``stay`` until the user stops.

    Returns:
        The last complete run.

    Raises:
        Interrupted: the user stopped the run; a ``.partial`` directory is left.
        InputError: a scenario, or its run's folder, is invalid.
    """
    session, index = service.session, service.first
    session.seed = service.seed
    session.scenarios = [scenario.id for scenario in service.scenarios]
    last: Run | None = None
    with _quick_switches():
        while True:
            scenario = service.scenarios[index]
            run = _serve_one(service, scenario)
            last = run or last
            request = session.take_request()
            if run is not None and not request and service.stay:
                request = session.wait_for_request()
            if not request:
                return _ended(last)
            if request == "next":
                index = (index + 1) % len(service.scenarios)
            elif request == "load":
                index = session.scenarios.index(session.requested)


def _ended(last: Run | None) -> Run:
    if last is None:
        raise Interrupted("interrupted before a run was complete")
    return last


@contextmanager
def _quick_switches() -> Iterator[None]:
    """Switch threads quickly, since each step waits for the connections' thread."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(_SWITCH)
    try:
        yield
    finally:
        sys.setswitchinterval(usual)


def _serve_one(service: LiveServe, scenario: Scenario) -> Run | None:
    """Run once; return None if a client requested another run before its end."""
    from crowdbot.core.sim.preflight import preflight
    from crowdbot.core.sim.simulate import make_run

    session, policy, robots = service.session, service.policy, tuple(scenario.robots)
    scenes: dict[str, LiveScene] = {}
    steps = LiveSteps(session, service.connections, policy, robots)
    choice = live_choice(
        service.name, policy, robots, lambda robot: LivePlanner(steps, scenes[robot])
    )
    request = service.request(scenario, choice, session.seed)
    stop = lambda: session.must_stop  # noqa: E731
    request = replace(
        request,
        options=replace(request.options, force=True),
        stop=stop,
        watchers=service.watchers,
        on_begin=steps.begin_run if len(robots) > 1 else None,
    )
    builts = preflight(request)
    scenes |= _scenes(request, builts)
    session.begin(scenario.id, session.seed, robots)
    for name, space in namespaces(builts).items():
        session.robots[space].limits = builts[name].model.limits
    state: State = "ended"
    try:
        prepared = prepare(scenario, request.registry, references=request.options.references)
        run = make_run(request, prepared, builts=builts)
        state = Ending(run.status)
    except Interrupted:
        if session.interrupted():
            raise
        return None
    finally:
        session.finish(state)
        for connection in service.connections:
            connection.publish([status(session, policy.epoch)])
    run = _remember(run, session, policy)
    service.on_run(run)
    return run


def live_choice(
    name: str, policy: StepPolicy, robots: Sequence[str], build: Callable[[str], LivePlanner]
) -> PlannerChoice:
    """Return a planner choice that listens to external commands.

    Args:
        name: the planner's name.
        policy: timing of the steps.
        robots: names of the robots.
        build: function that builds the planner of a robot.

    Raises:
        InputError: the name is not valid for a folder.
    """
    if not name or name.startswith(".") or set(name) & set("/\\\0"):
        raise InputError(f"'{name}' cannot be the name of a planner, which a folder has")
    spec = {k: v for k, v in asdict(policy).items() if k != "wait"}
    choice = PlannerChoice(
        name=name,
        spec_dump={"kind": "live", **spec},
        build=partial(build, next(iter(robots), "")),
        pinned=False,
        needs=None,
        label=name,
        origin="a live connection",
        patience=math.inf,
    )
    if len(robots) < 2:
        return choice
    return replace(choice, fleet={r: replace(choice, build=partial(build, r)) for r in robots})


def live_robots(scenarios: Iterable[Scenario]) -> dict[str, LiveRobot]:
    """Return the robots of scenarios for a session, by the namespace of their topics."""
    spaces = (space for each in scenarios for space in namespaces(each.robots).values())
    return {space: LiveRobot() for space in spaces}


def _scenes(request: Request, builts: Mapping[str, BuiltRun]) -> dict[str, LiveScene]:
    """Return the data of each robot that clients get."""
    spaces = namespaces(builts)
    return {
        name: LiveScene(
            scenario=request.scenario.id,
            name=name,
            namespace=spaces[name],
            parts=built.parts,
            model=built.model,
            sensors={n: built.infos[n] for n in built.visible},
        )
        for name, built in builts.items()
    }


def _remember(run: Run, session: LiveSession, policy: StepPolicy) -> Run:
    """Add data of the live run to run.json."""
    counts = session.counts
    live = LivePart(steps=counts.steps, missed_steps=counts.missed, refused_commands=counts.refused)
    if policy.rate is not None:
        live = live.model_copy(update={"largest_lag": round(counts.most_lag, 4)})
    return with_live_part(run, live)
