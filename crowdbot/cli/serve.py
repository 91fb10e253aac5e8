"""``crowdbot serve``: programs outside drive the robot of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crowdbot.cli._options import NoPlugins, Plugins, installed
from crowdbot.cli._serve_options import ClockChoice, DistroChoice, MissedChoice
from crowdbot.cli.simulate import RecordChoice

if TYPE_CHECKING:
    from crowdbot.core.planning.resolve import PlannerChoice
    from crowdbot.dsl.scenario import Scenario


def serve(
    spec: Annotated[str, typer.Argument(metavar="SPEC", help="File, or name of a suite.")],
    scenario: Annotated[
        str | None, typer.Argument(metavar="[ID]", help="Scenario: id, unique prefix or pattern.")
    ] = None,
    host: Annotated[
        str, typer.Option(help="Address to listen on; one that others reach needs a token.")
    ] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port of the rosbridge server; 0: a free one.")
    ] = 9090,
    token: Annotated[
        str | None, typer.Option(help="What clients must know; default on the network: a new one.")
    ] = None,
    connect: Annotated[
        str | None,
        typer.Option(metavar="ws://HOST:PORT", help="Be a client of this rosbridge server."),
    ] = None,
    stamped: Annotated[
        bool, typer.Option("--stamped", help="With --connect: commands are TwistStamped.")
    ] = False,
    zenoh: Annotated[
        str | None,
        typer.Option(metavar="tcp/HOST:PORT", help="ROS 2 topics, too, through this zenoh router."),
    ] = None,
    zenoh_router: Annotated[
        bool, typer.Option("--zenoh-router", help="Be the zenoh router at that endpoint.")
    ] = False,
    domain: Annotated[int, typer.Option(min=0, max=232, help="ROS_DOMAIN_ID.")] = 0,
    distro: Annotated[
        DistroChoice, typer.Option(help="ROS 2 distribution of the nodes.")
    ] = DistroChoice.jazzy,
    foxglove: Annotated[
        int | None,
        typer.Option(min=0, max=65535, metavar="PORT", help="A live view for Foxglove as well."),
    ] = None,
    rate: Annotated[
        float | None,
        typer.Option(metavar="FACTOR", help="Keep to real time, times FACTOR; else lockstep."),
    ] = None,
    clock: Annotated[
        ClockChoice, typer.Option(help="Who says what time it is.")
    ] = ClockChoice.internal,
    budget: Annotated[
        float, typer.Option(metavar="SECONDS", help="Lockstep: how long a step waits.")
    ] = 5.0,
    missed: Annotated[
        MissedChoice, typer.Option(help="What a step without a command does.")
    ] = MissedChoice.stop,
    hold: Annotated[
        float, typer.Option(metavar="SECONDS", help="Real time: how long a command counts.")
    ] = 0.5,
    wait: Annotated[
        float | None,
        typer.Option(metavar="SECONDS", help="How long to wait for a client; default: for ever."),
    ] = None,
    epoch: Annotated[
        int, typer.Option(min=0, metavar="SECONDS", help="Time at which stamps begin.")
    ] = 0,
    ros: Annotated[int, typer.Option(min=1, max=2, help="ROS 1 or ROS 2 messages.")] = 2,
    name: Annotated[str, typer.Option(help="Name of the planner that drives.")] = "live",
    stay: Annotated[
        bool, typer.Option("--stay", help="Go on after a run: reset, next_scenario.")
    ] = False,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change the scenario; repeatable."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Run seed: sensor noise and planner.")] = 0,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Root of the run directories.")] = Path(
        "runs"
    ),
    record: Annotated[
        RecordChoice, typer.Option(help="Sensors to simulate and record.")
    ] = RecordChoice.all,
    references: Annotated[
        bool, typer.Option(help="Drive alone first, and run people alone, to compare with.")
    ] = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, typer.Option("--json", help="JSON on stdout.")] = False,
) -> None:
    """Serve one scenario as a rosbridge server: a program outside drives the robot.

    Example: crowdbot serve challenge-2020 in-d0125-slow-c01-r02 --port 9090
    """
    from crowdbot.cli._serve_options import Listen, listening, manner_of, report
    from crowdbot.cli.simulate import _import_simulate, _interruptible, _print
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    times = {"budget": budget, "hold": hold, "wait": wait}
    manner = manner_of(rate, clock, missed, times, epoch)
    with stdout_to_stderr():
        registry = installed(plugin, no_plugins)
        expansion = open_spec(spec, registry, overrides or ())
        whole = scenario is None and not expansion.single
        chosen = expansion.scenarios[0] if whole else pick(expansion, scenario)
        _import_simulate()
        from crowdbot.core.live.serve import LiveServe, serve_runs
        from crowdbot.core.live.session import LiveSession
        from crowdbot.core.runs.request import Request

        def request(of: Scenario, choice: PlannerChoice, run_seed: int) -> Request:
            return Request(
                scenario=of,
                choice=choice,
                registry=registry,
                seed=run_seed,
                out=out,
                suite="scenarios" if expansion.single else expansion.suite_id,
                metrics=expansion.metrics,
                axes=expansion.axes.get(of.id, {}),
                words=expansion.words_of(of.id),
                position=expansion.scenarios.index(of),
                record=record.value,
                references=references,
            )

        with _interruptible() as stop:
            session = LiveSession(interrupted=stop)
            listen = Listen(
                host=host,
                port=port,
                token=token,
                ros=ros,
                connect=connect,
                stamped=stamped,
                zenoh=zenoh,
                zenoh_router=zenoh_router,
                domain=domain,
                distro=distro,
                foxglove=foxglove,
            )
            with listening(session, manner, listen) as doors:
                service = LiveServe(
                    session=session,
                    doors=doors,
                    manner=manner,
                    scenarios=expansion.scenarios,
                    first=expansion.scenarios.index(chosen),
                    request=request,
                    name=name,
                    seed=seed,
                    stay=stay,
                    on_run=lambda run: report(run.record),
                )
                run = serve_runs(service)
    _print(run, as_json=as_json)
    if run.status == "planner_failed":
        raise typer.Exit(3)
