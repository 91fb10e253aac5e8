"""``crowdbot walk``: a person walks in the crowd from a page in the browser."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import crowdbot.cli.shared.run_arguments as run_arguments
from crowdbot.cli.serving.person_run import PagePorts, PersonRun, page_of, request_of, show_end
from crowdbot.cli.shared.option import option
from crowdbot.cli.shared.options import MakeReferences, NoPlugins, PlannerSet, Plugins, installed
from crowdbot.cli.shared.person_arguments import OpenPage, PagePort, Rate, ReplayRun
from crowdbot.errors import UsageError

if TYPE_CHECKING:
    from crowdbot.core.runs.run import Request, Run
    from crowdbot.core.sim.built_run import BuiltRun
    from crowdbot.dsl.scenario.scenario import Scenario

#: Places beyond are typing errors, m.
_FARTHEST = 1e6


def walk(
    spec: run_arguments.SpecArgument,
    scenario: run_arguments.ScenarioArgument = None,
    at: Annotated[str | None, option("X,Y", "Your start, m; default: a free place.")] = None,
    goal: Annotated[
        str | None, option("X,Y", "Your own goal, m: your trip is then scored, too.")
    ] = None,
    speed: Annotated[
        float,
        typer.Option(min=0.1, max=2.5, metavar="M/S", help="Your speed at full deflection."),
    ] = 1.4,
    planner: Annotated[
        list[str] | None,
        option(
            "[ROBOT=]NAME|FILE|file.py:Class",
            "The planner of the robot; default dwa. ROBOT=PLANNER for several; repeatable.",
        ),
    ] = None,
    planner_set: PlannerSet = None,
    duration: Annotated[
        float | None, option("SECONDS", "Of a scenario without a robot; default 60.")
    ] = None,
    port: PagePort = 0,
    open_: OpenPage = False,
    rate: Rate = 1.0,
    replay: ReplayRun = None,
    overrides: run_arguments.Overrides = None,
    seed: run_arguments.RunSeed = 0,
    out: run_arguments.OutRoot = Path("runs"),
    record: run_arguments.Record = run_arguments.RecordChoice.used,
    references: MakeReferences = True,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    everything: run_arguments.AllScores = False,
    as_json: run_arguments.AsJson = False,
) -> None:
    """Walk in the crowd yourself, with a body that people and robots see and avoid.

    The run takes real time and waits while no page is open. Your own way is not scored, unless
    it has a goal.

    Example: crowdbot walk challenge-2020 counter-d0250-dispersed-c20-r05 --at 6,0 --open

    Example: crowdbot walk challenge-2020 counter-d0250-dispersed-c20-r05 --replay runs/RUN
    """
    from crowdbot.cli.shared.one_run import import_simulate, interruptible, print_run
    from crowdbot.core.live.person.walking import WalkerBody
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    with stdout_to_stderr():
        given = PersonRun(
            spec=spec, scenario=scenario, overrides=overrides or (), seed=seed, out=out,
            record=record.value, references=references, duration=duration,
        )  # fmt: skip
        without = request_of(given, installed(plugin, no_plugins))
        import_simulate()
        body = WalkerBody(at=_point("--at", at), goal=_point("--goal", goal), speed=speed)
        request, builts = _with_person(without, body, planner or (), planner_set or ())
        if replay is not None:
            from crowdbot.core.live.person.walk import walk_again

            run = walk_again(request, builts, without.scenario, replay)
        else:
            with interruptible() as stop:
                ports = PagePorts(port=port, open_=open_, rate=rate)
                run = _walked(request, builts, without.scenario, ports, stop, speed)
    print_run(run, as_json=as_json, everything=everything)
    if run.failed:
        raise typer.Exit(3)


def _point(option: str, text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f"{option} {text}: a place is X,Y in m, such as 6,-0.5") from None
    if not (abs(x) < _FARTHEST and abs(y) < _FARTHEST):  # NaN too
        raise UsageError(f"{option} {text}: write two numbers below 1 000 000 m")
    return x, y


def _with_person(
    without: Request, body: Any, planners: list[str] | tuple[()], settings: list[str] | tuple[()]
) -> tuple[Request, Mapping[str, BuiltRun]]:
    """Add the person to the scenario; return the new request, and robot name -> built run."""
    from crowdbot.cli.commands.run.simulate import one_or_several
    from crowdbot.core.live.person.walking import with_person
    from crowdbot.core.planning.given_planner import choose_planner
    from crowdbot.core.sim.preflight import preflight

    scenario = with_person(without.scenario, without.registry, body)
    request = replace(without, scenario=scenario, options=replace(without.options, force=True))
    if not scenario.robots:
        if planners:
            raise UsageError(f"--planner {planners[0]}: {without.scenario.id} has no robot")
        return request, {}
    choice = choose_planner(one_or_several(planners), without.registry, settings)
    request = replace(request, choice=choice)
    return request, preflight(request)


def _walked(
    request: Request,
    builts: Mapping[str, BuiltRun],
    without: Scenario,
    ports: PagePorts,
    stop: Callable[[], bool],
    speed: float,
) -> Run:
    """Simulate the run while a person walks in the crowd from the page."""
    import numpy as np

    from crowdbot.core.environments.build import build_environment
    from crowdbot.core.live.person.picture import LivePicture
    from crowdbot.core.live.person.walk import seat_in_the_crowd, walk
    from crowdbot.core.live.person.walking import PERSON
    from crowdbot.core.scenarios.lock import population

    scenario = request.scenario
    people = population(scenario, request.registry).agents
    me = int(np.flatnonzero(people.id == PERSON)[0])
    about = {"driven": 0, "walker": me, "yaw": float(people.heading[me])}
    parts = build_environment(request.registry, scenario.environment)
    seat = seat_in_the_crowd(stop, ports.rate)
    with page_of(seat, "walk", scenario.id, ports) as server:
        picture = LivePicture(server, scenario, parts, builts, people, about)
        picture.show()
        watched = replace(request, watchers=[picture], on_begin=picture.begin_run)
        run = walk(watched, builts, seat, without, speed)
        show_end(server, run)
        return run
