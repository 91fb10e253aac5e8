"""Serve live runs: ordinary runs whose planner listens to external programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace

from crowdbot.core.live.door import Door
from crowdbot.core.live.planner import LivePlanner, Manner, status
from crowdbot.core.live.scene import LiveScene
from crowdbot.core.live.session import LiveSession, State
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.recording.watcher import Watcher
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.identity import prepare
from crowdbot.core.runs.record_parts import LivePart
from crowdbot.core.runs.run import Request, Run
from crowdbot.core.scenarios.one_robot import check_one_robot
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
    doors: Sequence[Door]
    manner: Manner
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
            wanted = session.take_request()
            if run is not None and not wanted and service.stay:
                wanted = session.wait_for_request()
            if not wanted:
                return _ended(last)
            if wanted == "next":
                index = (index + 1) % len(service.scenarios)
            elif wanted == "load":
                index = session.scenarios.index(session.wanted)


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
    from crowdbot.core.sim.simulate import make_run

    session = service.session
    scene: list[LiveScene] = []
    choice = live_choice(
        service.name, service.manner, lambda: LivePlanner(session, service.doors, scene[0], manner)
    )
    manner = service.manner
    request = service.request(scenario, choice, session.seed)
    stop = lambda: session.must_stop  # noqa: E731
    request = replace(
        request, options=replace(request.options, force=True), stop=stop, watchers=service.watchers
    )
    built = _built(request)
    scene.append(_scene(request, built))
    session.robot = scene[0].name
    session.begin(scenario.id, session.seed)
    state: State = "ended"
    try:
        prepared = prepare(scenario, request.registry, references=request.options.references)
        run = make_run(request, prepared, builts={built.name: built})
        state = Ending(run.status)
    except Interrupted:
        if session.interrupted():
            raise
        return None
    finally:
        session.finish(state)
        for door in service.doors:
            door.publish([status(session, manner.epoch)])
    run = _remember(run, session, manner)
    service.on_run(run)
    return run


def live_choice(name: str, manner: Manner, build: Callable[[], LivePlanner]) -> PlannerChoice:
    """Return a planner choice that listens to external commands.

    Raises:
        InputError: the name is not valid for a folder.
    """
    if not name or name.startswith(".") or set(name) & set("/\\\0"):
        raise InputError(f"'{name}' cannot be the name of a planner, which a folder has")
    spec = {k: v for k, v in asdict(manner).items() if k != "wait"}
    return PlannerChoice(
        name=name,
        spec_dump={"kind": "live", **spec},
        build=build,
        pinned=False,
        needs=None,
        label=name,
        origin="a live connection",
        patience=math.inf,
    )


def _built(request: Request) -> BuiltRun:
    """Build the run of the only robot; clients get the data of this robot."""
    from crowdbot.core.sim.preflight import preflight

    check_one_robot(request.scenario, "'crowdbot serve'")
    (built,) = preflight(request).values()
    return built


def _scene(request: Request, built: BuiltRun) -> LiveScene:
    return LiveScene(
        scenario=request.scenario.id,
        name=built.name,
        parts=built.parts,
        model=built.model,
        sensors={n: built.infos[n] for n in built.visible},
    )


def _remember(run: Run, session: LiveSession, manner: Manner) -> Run:
    """Add data of the live run to run.json."""
    counts = session.counts
    lag = {} if manner.rate is None else {"largest_lag": round(counts.most_lag, 4)}
    live = LivePart(
        steps=counts.steps, missed_steps=counts.missed, refused_commands=counts.refused, **lag
    )
    record = run.record.model_copy(update={"live": live})
    files.attach_files(run.directory, record.document())
    record = record.model_copy(update={"files": files.sizes(run.directory)})
    record.write(run.directory)
    return replace(run, record=record)
