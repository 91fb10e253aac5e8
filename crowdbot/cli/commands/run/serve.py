"""``crowdbot serve``: let external programs drive the robots of a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

import crowdbot.cli.serving.serve_arguments as arguments
import crowdbot.cli.shared.run_arguments as run_arguments
from crowdbot.cli.shared.options import NoPlugins, Plugins, installed
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.cli.serving.serve_options import Listen
    from crowdbot.core.live.step_policy import StepPolicy
    from crowdbot.core.planning.resolve import PlannerChoice
    from crowdbot.core.registry.registry import Registry
    from crowdbot.core.runs.run import Request, Run
    from crowdbot.dsl.scenario.scenario import Scenario
    from crowdbot.dsl.suite.expansion import Expansion


def serve(
    spec: run_arguments.SpecArgument,
    scenario: run_arguments.ScenarioArgument = None,
    host: arguments.Host = "127.0.0.1",
    port: arguments.Port = 9090,
    token: arguments.Token = None,
    connect: arguments.Connect = None,
    stamped: arguments.Stamped = False,
    zenoh: arguments.Zenoh = None,
    zenoh_router: arguments.ZenohRouter = False,
    domain: arguments.Domain = 0,
    distro: arguments.Distro = arguments.DistroChoice.jazzy,
    foxglove: arguments.Foxglove = None,
    allow_origin: arguments.AllowOrigin = None,
    meshcat: run_arguments.MeshcatPort = None,
    rate: arguments.Rate = None,
    clock: arguments.Clock = arguments.ClockChoice.internal,
    budget: arguments.Budget = 5.0,
    missed: arguments.Missed = arguments.MissedChoice.stop,
    hold: arguments.Hold = 0.5,
    wait: arguments.Wait = None,
    epoch: arguments.Epoch = 0,
    ros: arguments.RosVersion = 2,
    name: arguments.PlannerName = "live",
    stay: arguments.Stay = False,
    overrides: run_arguments.Overrides = None,
    seed: run_arguments.RunSeed = 0,
    out: run_arguments.OutRoot = Path("runs"),
    record: run_arguments.Record = run_arguments.RecordChoice.all,
    references: arguments.References = False,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    everything: run_arguments.AllScores = False,
    as_json: run_arguments.AsJson = False,
) -> None:
    """Serve one scenario as a rosbridge server: external programs drive its robots.

    Example: crowdbot serve challenge-2020 in-d0125-slow-c01-r02 --port 9090
    """
    from crowdbot.cli.serving.serve_options import Listen, step_policy_of
    from crowdbot.cli.shared.one_run import print_run
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    times = {"budget": budget, "hold": hold, "wait": wait}
    policy = step_policy_of(rate, clock, missed, times, epoch)
    listen = Listen(
        host=host, port=port, token=token, ros=ros, connect=connect, stamped=stamped,
        zenoh=zenoh, zenoh_router=zenoh_router, domain=domain, distro=distro, foxglove=foxglove,
        origins=tuple(allow_origin or ()),
    )  # fmt: skip
    with stdout_to_stderr():
        registry = installed(plugin, no_plugins)
        served = _served(registry, spec, scenario, overrides)
        how = _Serving(
            out=out, record=record, references=references, name=name, seed=seed, stay=stay,
            meshcat=meshcat,
        )  # fmt: skip
        run = _serve(served, how, policy, listen)
    print_run(run, as_json=as_json, everything=everything)
    if run.failed:
        raise typer.Exit(3)


@dataclass(frozen=True, kw_only=True)
class _Served:
    """The suite, and the index of the first scenario."""

    registry: Registry
    expansion: Expansion
    first: int


@dataclass(frozen=True, kw_only=True)
class _Serving:
    """The run options of ``crowdbot serve``."""

    out: Path
    record: run_arguments.RecordChoice
    references: bool
    name: str
    seed: int
    stay: bool
    meshcat: int | None


def _served(
    registry: Registry, spec: str, scenario: str | None, overrides: list[str] | None
) -> _Served:
    from crowdbot.core.scenarios.library import open_spec, pick

    expansion = open_spec(spec, registry, overrides or ())
    whole = scenario is None and not expansion.single
    chosen = expansion.scenarios[0] if whole else pick(expansion, scenario)
    if not chosen.robots:  # before anyone is asked to connect
        raise InputError(f"{chosen.id} has no robot, and 'crowdbot serve' drives robots")
    first = expansion.scenarios.index(chosen)
    return _Served(registry=registry, expansion=expansion, first=first)


def _serve(served: _Served, how: _Serving, policy: StepPolicy, listen: Listen) -> Run:
    from crowdbot.cli.serving.serve_options import listening, report, watchers_of
    from crowdbot.cli.shared.one_run import import_simulate, interruptible

    import_simulate()
    from crowdbot.core.live.serve import LiveServe, live_robots, serve_runs
    from crowdbot.core.live.session import LiveSession

    with interruptible() as stop:
        session = LiveSession(interrupted=stop, robots=live_robots(served.expansion.scenarios))
        with listening(session, policy, listen) as connections:
            service = LiveServe(
                session=session,
                connections=connections,
                policy=policy,
                scenarios=served.expansion.scenarios,
                first=served.first,
                request=lambda *asked: _request(served, how, *asked),
                name=how.name,
                seed=how.seed,
                stay=how.stay,
                watchers=watchers_of(connections, how.meshcat),
                on_run=lambda run: report(run.record),
            )
            return serve_runs(service)


def _request(
    served: _Served, how: _Serving, scenario: Scenario, choice: PlannerChoice, seed: int
) -> Request:
    from crowdbot.core.runs.run import Request
    from crowdbot.core.runs.run_options import RunOptions

    expansion = served.expansion
    return Request(
        scenario=scenario,
        choice=choice,
        registry=served.registry,
        seed=seed,
        out=how.out,
        entry=expansion.entry(scenario),
        options=RunOptions(
            record=how.record.value, references=how.references, metrics=expansion.metrics
        ),
    )
