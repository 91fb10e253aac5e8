"""``crowdbot simulate``: run one scenario with one planner, record it, score it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import crowdbot.cli.shared.options as shared
import crowdbot.cli.shared.run_arguments as run_arguments
from crowdbot.cli.shared.option import option, switch
from crowdbot.errors import UsageError

if TYPE_CHECKING:
    from crowdbot.dsl.scenario.scenario import Scenario


def simulate(
    spec: run_arguments.SpecArgument,
    scenario: run_arguments.ScenarioArgument = None,
    planner: Annotated[
        list[str] | None,
        option(
            "[ROBOT=]NAME|FILE|file.py:Class",
            "The planner under test, dwa by default; repeatable with the names of robots.",
        ),
    ] = None,
    overrides: run_arguments.Overrides = None,
    planner_set: shared.PlannerSet = None,
    seed: run_arguments.RunSeed = 0,
    out: run_arguments.OutRoot = Path("runs"),
    record: Annotated[
        run_arguments.RecordChoice | None,
        typer.Option(help="Sensors to simulate and record; default: the suite's, or used."),
    ] = None,
    references: shared.MakeReferences = True,
    force: Annotated[bool, switch("--force", "Run again, even if the run is complete.")] = False,
    step_budget: Annotated[
        float | None, option("SECONDS", "Wall time that a planner step may take.")
    ] = None,
    replace_draws: shared.ReplaceDraws = 0,
    duration: Annotated[
        float | None,
        option("SECONDS", "How long people walk in a scenario without a robot; default 60."),
    ] = None,
    in_process: shared.InProcess = None,
    planner_memory: shared.PlannerMemory = shared.MEMORY_GIB,
    meshcat: run_arguments.MeshcatPort = None,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    everything: run_arguments.AllScores = False,
    as_json: run_arguments.AsJson = False,
) -> None:
    """Simulate one scenario with one planner, or its people alone; record, score and replay it.

    Example: crowdbot simulate challenge-2020 counter-d0250-dispersed-c20-r05 --planner dwa

    Several robots: crowdbot simulate two.yaml --planner a=dwa --planner b=mine.py:Mine
    """
    from crowdbot.cli.serving.serve_options import meshcat_view
    from crowdbot.cli.shared import one_run
    from crowdbot.cli.shared.progress import show_progress
    from crowdbot.core.runs.run_options import RunOptions
    from crowdbot.core.scenarios.library import open_spec, pick
    from crowdbot.core.support.stdout_guard import stdout_to_stderr

    with stdout_to_stderr():
        registry = shared.installed(plugin, no_plugins)
        expansion = open_spec(spec, registry, overrides or ())
        chosen = pick(expansion, scenario)
        _check_planners(planner or (), chosen)
        simulate_it = one_run.import_simulate()
        watchers = meshcat_view(meshcat)
        with one_run.interruptible() as stop, show_progress() as progress:
            run = simulate_it(
                chosen,
                registry,
                planner=one_or_several(planner),
                planner_settings=planner_set or (),
                seed=seed,
                out=out,
                entry=expansion.entry(chosen),
                options=RunOptions(
                    record=(expansion.record or "used") if record is None else record.value,
                    references=references,
                    force=force,
                    metrics=expansion.metrics,
                    step_budget=step_budget,
                    replace_draws=replace_draws,
                    duration=duration,
                    place=shared.planner_place(in_process, planner_memory),
                ),
                progress=progress,
                stop=stop,
                on_hang=one_run.end_hung_process,
                watchers=watchers,
            )
    one_run.print_run(run, as_json=as_json, everything=everything)
    if run.failed:
        raise typer.Exit(3)


def _check_planners(planners: Sequence[str], scenario: Scenario) -> None:
    if planners and not scenario.robots:
        raise UsageError(f"--planner {planners[0]}: {scenario.id} has no robot to drive")


def one_or_several(planners: Sequence[str] | None) -> str:
    """Return one planner for all robots, or one for each, in the format of `resolve_planner`.

    Raises:
        UsageError: there are several, and one does not name its robot.
    """
    from crowdbot.core.planning.fleet_choice import planners_by_robot

    given = list(planners or ("dwa",))
    for text in given if len(given) > 1 else ():
        if not planners_by_robot(text):
            raise UsageError(f"--planner {text}: of which robot? Write ROBOT={text}")
    return ",".join(given)
