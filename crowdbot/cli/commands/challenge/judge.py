"""``crowdbot judge``: run sealed planners on a suite's draws, as its organiser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.campaign_run import run_plan, worker_count
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.run_arguments import AsJson
from crowdbot.core.support.text import plural


def judge(
    suite: Annotated[str, argument("SUITE", "File or name of the suite.")],
    submissions: Annotated[Path, argument("SUBMISSIONS", "Folder of sealed planners (*.cbs).")],
    out: Annotated[Path, option("DIR", "Folder to write: log, runs and bundles.")] = Path("judged"),
    jobs: Annotated[int, typer.Option(min=0, metavar="N", help="Processes; 0: one per core.")] = 0,
    cluster: Annotated[str | None, option("ADDRESS", "Scheduler of a Dask cluster.")] = None,
    not_contained: Annotated[
        bool, switch("--not-contained", "Run planners that this system does not contain.")
    ] = False,
    planner_memory: shared.PlannerMemory = shared.MEMORY_GIB,
    step_budget: Annotated[
        float | None, option("SECONDS", "Wall time that a planner step may take; default: 10 s.")
    ] = None,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Receive sealed planners, and run them once the suite's draws are open.

    While the draws are hidden, submissions are logged only; later ones are refused. Planners
    run one after another; after an interruption, the same command continues. crowdbot judge-log
    checks the log. A step budget limits the time that a slow planner takes.

    Example: crowdbot judge challenge.yaml submissions --out judged --jobs 4
    """
    from crowdbot.core.campaign.judge import Judge
    from crowdbot.core.campaign.judge import judge as judge_all
    from crowdbot.core.runs.run_options import RunOptions

    place = shared.planner_place(False, planner_memory, lenient=True, contained=not not_contained)
    setup = Judge(
        suite=suite,
        submissions=submissions,
        out=out,
        registry=shared.installed(plugin, no_plugins),
        run=lambda plan: run_plan(plan, worker_count(jobs), cluster),
        options=RunOptions(place=place, replay=False, step_budget=step_budget),
        plugins=plugin or (),
    )
    found = judge_all(setup)
    for name, why in found.left_out.items():
        say(f"warning: {name} is left out: {why}", err=True)
    if as_json:
        document = {
            "received": found.received, "waits": found.waits, "left_out": found.left_out,
            "judged": {name: str(path) for name, path in found.judged.items()},
        }  # fmt: skip
        say_json(document)
    else:
        for name, path in found.judged.items():
            say(f"{name}: {path}")
        outcome = "the draws are hidden: nothing was run" if found.waits else (
            f"{plural(len(found.judged), 'planner')} judged"
        )  # fmt: skip
        say(f"{plural(len(found.received), 'new submission')} received; {outcome}")
    if found.left_out:
        raise typer.Exit(1)
