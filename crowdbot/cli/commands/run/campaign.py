"""``crowdbot campaign``: suites × planners × seeds; only missing runs are executed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import crowdbot.cli.shared.options as shared
from crowdbot.cli.output.say import say, say_json
from crowdbot.cli.shared.campaign_run import print_plan, read_seeds, run_plan, worker_count
from crowdbot.cli.shared.option import argument, option, switch
from crowdbot.cli.shared.run_arguments import AsJson, RecordChoice

if TYPE_CHECKING:
    from crowdbot.core.campaign.run import State

_PlannerSet = Annotated[list[str] | None, option("KEY=VALUE", "Change every planner; repeatable.")]
_Planner = Annotated[list[str] | None, option("NAME|FILE|file.py:Class", "A planner; repeatable.")]
_Crowds = Annotated[
    str | None, option("NAME,NAME", "Run every scenario in each of these crowds: the axis 'crowd'.")
]
_Seeds = Annotated[
    str | None, option("0,1,2|0..4", "Run seeds; default: those of the suite, or 0.")
]
_Out = Annotated[Path, option("DIR", "Root of the run directories.")]
_Record = Annotated[RecordChoice, typer.Option(help="Sensors to simulate and record.")]


def campaign(
    suites: Annotated[list[str], argument("SUITE...", "Files or names.")],
    planner: _Planner = None,
    seeds: _Seeds = None,
    only: shared.OnlyScenarios = None,
    crowds: _Crowds = None,
    out: _Out = Path("runs"),
    jobs: shared.Jobs = 0,
    record: _Record = RecordChoice.used,
    replay: Annotated[bool, typer.Option(help="Write the replay pages.")] = True,
    overrides: shared.EveryScenarioSet = None,
    planner_set: _PlannerSet = None,
    floors: Annotated[
        bool,
        typer.Option(help="Also run floors and ceilings, in at most 18 scenarios of a suite."),
    ] = True,
    retry_failed: Annotated[
        bool, switch("--retry-failed", "Repeat runs whose planner failed.")
    ] = False,
    replace_draws: shared.ReplaceDraws = 0,
    force: Annotated[
        bool, switch("--force", "Run everything again, calibration runs too.")
    ] = False,
    dry_run: Annotated[bool, switch("--dry-run", "Print the plan only.")] = False,
    cluster: Annotated[str | None, option("tcp://HOST:PORT", "A Dask scheduler.")] = None,
    in_process: shared.InProcess = None,
    planner_memory: shared.PlannerMemory = shared.MEMORY_GIB,
    plugin: shared.Plugins = None,
    no_plugins: shared.NoPlugins = False,
    as_json: AsJson = False,
) -> None:
    """Run every scenario with every planner and seed; completed runs are skipped.

    Example: crowdbot campaign challenge-2020 --planner dwa --planner goal_seek --jobs 2
    """
    from crowdbot.core.campaign.plan import make_plan
    from crowdbot.core.campaign.request import CampaignRequest
    from crowdbot.core.runs.run_options import RunOptions

    options = RunOptions(
        record=record.value,
        replay=replay,
        retry_failed=retry_failed,
        replace_draws=replace_draws,
        force=force,
        place=shared.planner_place(in_process, planner_memory, lenient=True),
    )
    registry = shared.installed(plugin, no_plugins)
    request = CampaignRequest(
        suites=suites,
        planners=planner or (),
        floors=floors,
        seeds=None if seeds is None else read_seeds(seeds),
        only=only or (),
        crowds=[name.strip() for name in (crowds or "").split(",") if name.strip()],
        out=out,
        options=options,
        overrides=overrides or (),
        planner_settings=planner_set or (),
        plugins=plugin or (),
    )
    plan = make_plan(request, registry)
    size = worker_count(jobs)
    if dry_run:
        print_plan(plan, size, as_json=as_json)
        return
    try:
        state = run_plan(plan, size, cluster)
    except KeyboardInterrupt:
        say("interrupted; the same command makes the runs that are missing", err=True)
        raise
    if as_json:
        say_json(_document(state))
    if state.exit_code:
        raise typer.Exit(state.exit_code)


def _document(state: State) -> dict[str, Any]:
    statuses = list(state.statuses.values())
    return {
        "out": str(state.plan.out),
        "runs": len(state.plan.runs),
        "made": state.made,
        "statuses": {s: statuses.count(s) for s in sorted(set(statuses))},
        "failures": [
            {"job": job.title, "error": state.failures[job.key].error}
            for job in state.plan.jobs
            if job.key in state.failures
        ],
    }
