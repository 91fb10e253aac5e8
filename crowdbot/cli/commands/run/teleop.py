"""``crowdbot teleop``: a person drives a robot from a page in the browser."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import crowdbot.cli.shared.run_arguments as run_arguments
from crowdbot.cli.serving.person_run import PagePorts, PersonRun, page_of, request_of, show_end
from crowdbot.cli.shared.option import option
from crowdbot.cli.shared.options import NoPlugins, PlannerSet, Plugins, installed
from crowdbot.cli.shared.person_arguments import OpenPage, PagePort, Rate, ReplayRun

if TYPE_CHECKING:
    from crowdbot.core.live.person.teleop import Controls
    from crowdbot.core.runs.run import Request, Run


def teleop(
    spec: run_arguments.SpecArgument,
    scenario: run_arguments.ScenarioArgument = None,
    robot: Annotated[
        str | None, typer.Option(help="The robot with the stick; default: the first.")
    ] = None,
    planner: Annotated[
        list[str] | None,
        option(
            "NAME|ROBOT=NAME",
            "Planner that shares control with you; or ROBOT=PLANNER for another robot.",
        ),
    ] = None,
    planner_set: PlannerSet = None,
    port: PagePort = 0,
    open_: OpenPage = False,
    rosbridge: Annotated[
        int | None,
        typer.Option(
            min=0,
            max=65535,
            metavar="PORT",
            help="Programs drive, too: /cmd_vel and /joy by rosbridge, while the seat is free.",
        ),
    ] = None,
    zenoh: Annotated[
        str | None, option("tcp/HOST:PORT", "Programs drive, too: by ROS 2 and a zenoh router.")
    ] = None,
    rate: Rate = 1.0,
    replay: ReplayRun = None,
    name: Annotated[
        str, typer.Option(help="Name of the planner in the record; default: teleop.")
    ] = "",
    overrides: run_arguments.Overrides = None,
    seed: run_arguments.RunSeed = 0,
    out: run_arguments.OutRoot = Path("runs"),
    record: run_arguments.Record = run_arguments.RecordChoice.used,
    references: Annotated[
        bool,
        typer.Option(
            help="Simulate the people without the robot first, to compare with; once is enough."
        ),
    ] = True,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    everything: run_arguments.AllScores = False,
    as_json: run_arguments.AsJson = False,
) -> None:
    """Drive a robot yourself: keyboard, mouse, touch or gamepad, in a page on this machine.

    The run takes real time and waits while no page is open. Its directory is that of an
    ordinary run; your commands are the readings of a joystick in its recording.

    Example: crowdbot teleop challenge-2020 counter-d0250-dispersed-c20-r05 --open

    Example: crowdbot teleop challenge-2020 counter-d0250-dispersed-c20-r05 --replay runs/RUN
    """
    from crowdbot.cli.shared.one_run import import_simulate, interruptible, print_run
    from crowdbot.core.planning.fleet_choice import planners_by_robot
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    with stdout_to_stderr():
        given = PersonRun(
            spec=spec, scenario=scenario, overrides=overrides or (), seed=seed, out=out,
            record=record.value, references=references,
        )  # fmt: skip
        request = request_of(given, installed(plugin, no_plugins))
        import_simulate()
        from crowdbot.core.live.person.teleop import controls_of

        named = [planners_by_robot(text) for text in planner or ()]
        controls = controls_of(
            request.scenario,
            request.registry,
            robot=robot,
            assist=next((t for t, by in zip(planner or (), named, strict=True) if not by), None),
            settings=planner_set or (),
            others={k: v for by in named for k, v in by.items()},
            name=name,
        )
        if replay is not None:
            run = _again(request, controls, replay)
        else:
            with interruptible() as stop:
                ports = PagePorts(
                    port=port, open_=open_, rosbridge=rosbridge, zenoh=zenoh, rate=rate
                )
                run = _driven(request, controls, ports, stop)
    print_run(run, as_json=as_json, everything=everything)
    if run.failed:
        raise typer.Exit(3)


def _driven(
    request: Request, controls: Controls, ports: PagePorts, stop: Callable[[], bool]
) -> Run:
    """Simulate the run while a person drives the robot from the page."""
    from dataclasses import replace

    from crowdbot.core.live.person import teleop as live
    from crowdbot.core.live.person.picture import LivePicture
    from crowdbot.core.scenarios.lock import population

    scenario, robot = request.scenario, controls.robot
    seat = live.seat_at(robot, stop, ports.rate)
    request, builts = live.built_with_stick(request, controls, live.seat_stick(seat))
    with page_of(seat, "drive", scenario.id, ports) as server:
        people = population(scenario, request.registry).agents
        about = {"driven": list(builts).index(robot), "walker": -1}
        parts = next(iter(builts.values())).parts
        picture = LivePicture(server, scenario, parts, builts, people, about)
        picture.show()
        watched = replace(request, watchers=[picture], on_begin=picture.begin_run)
        run = live.drive(watched, builts, seat, robot)
        show_end(server, run)
        return run


def _again(request: Request, controls: Controls, folder: Path) -> Run:
    """Simulate the run again with the joystick readings of a recorded run."""
    from crowdbot.core.live.person import teleop as live
    from crowdbot.core.live.person.recorded_stick import recorded_sticks

    several = len(request.scenario.robots) > 1
    make = recorded_sticks(folder, controls.robot if several else "")
    request, builts = live.built_with_stick(request, controls, make)
    return live.repeat(request, builts)
