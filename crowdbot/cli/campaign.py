"""``crowdbot campaign``: suites × planners × seeds; only what is missing is run."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from crowdbot.cli._options import NoPlugins, Plugins, installed
from crowdbot.cli.simulate import RecordChoice

if TYPE_CHECKING:
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.campaign.run import State

_Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change every scenario; repeatable."),
]
_PlannerSet = Annotated[
    list[str] | None,
    typer.Option(metavar="KEY=VALUE", help="Change every planner; repeatable."),
]
_Planner = Annotated[
    list[str] | None,
    typer.Option(metavar="NAME|FILE|file.py:Class", help="A planner; repeatable."),
]
_Only = Annotated[str | None, typer.Option(metavar="GLOB", help="Only scenarios that match.")]
_Seeds = Annotated[str, typer.Option(metavar="0,1,2|0..4", help="Run seeds.")]
_Out = Annotated[Path, typer.Option(metavar="DIR", help="Root of the run directories.")]
_Jobs = Annotated[int, typer.Option(min=0, help="Processes; 0 is one for each core.")]
_Record = Annotated[RecordChoice, typer.Option(help="Sensors to simulate and record.")]


def campaign(
    suites: Annotated[list[str], typer.Argument(metavar="SUITE...", help="Files or names.")],
    planner: _Planner = None,
    seeds: _Seeds = "0",
    only: _Only = None,
    out: _Out = Path("runs"),
    jobs: _Jobs = 0,
    record: _Record = RecordChoice.used,
    replay: Annotated[bool, typer.Option(help="Write the replay pages.")] = True,
    overrides: _Set = None,
    planner_set: _PlannerSet = None,
    retry_failed: Annotated[
        bool, typer.Option("--retry-failed", help="Run again where the planner failed.")
    ] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Print the plan only.")] = False,
    cluster: Annotated[
        str | None, typer.Option(metavar="tcp://HOST:PORT", help="A Dask scheduler.")
    ] = None,
    plugin: Plugins = None,
    no_plugins: NoPlugins = False,
    as_json: Annotated[bool, typer.Option("--json", help="JSON on stdout.")] = False,
) -> None:
    """Run every scenario with every planner and seed; what is complete is not run again.

    Example: crowdbot campaign challenge-2020 --planner dwa --planner goal_seek --jobs 2
    """
    from crowdbot.core.campaign.plan import make_plan
    from crowdbot.core.campaign.request import CampaignRequest

    registry = installed(plugin, no_plugins)
    request = CampaignRequest(
        suites=suites,
        planners=planner or (),
        seeds=read_seeds(seeds),
        only=only,
        out=out,
        record=record.value,
        replay=replay,
        overrides=overrides or (),
        planner_settings=planner_set or (),
        plugins=plugin or (),
        retry_failed=retry_failed,
    )
    plan = make_plan(request, registry)
    size = _size(jobs)
    if dry_run:
        _print_plan(plan, size, as_json=as_json)
        return
    state = _run(plan, size, cluster)
    if as_json:
        typer.echo(json.dumps(_document(state), indent=2))
    if state.exit_code:
        raise typer.Exit(state.exit_code)


def read_seeds(text: str) -> list[int]:
    """``0,1,2``, ``0..4``, or both mixed.

    Raises:
        UsageError: it is neither.
    """
    from crowdbot.errors import UsageError

    seeds: list[int] = []
    for part in text.split(","):
        found = re.fullmatch(r"\s*(\d{1,9})(?:\.\.(\d{1,9}))?\s*", part)
        if found is None or (found[2] and int(found[2]) < int(found[1])):
            raise UsageError(f"--seeds {text}: write 0,1,2 or 0..4")
        seeds += range(int(found[1]), int(found[2] or found[1]) + 1)
    return seeds


def _size(jobs: int) -> int:
    from crowdbot.core.runs.rescore import available_cores

    return jobs or available_cores()


def _run(plan: Plan, size: int, cluster: str | None) -> State:
    from crowdbot.cli._campaign_view import show
    from crowdbot.core.campaign.run import run_campaign
    from crowdbot.core.campaign.worker_pool import LocalWorkerPool, WorkerPool

    pool: WorkerPool
    if cluster is None:
        pool = LocalWorkerPool(min(size, max(1, len(plan.jobs))))
    else:
        from crowdbot.core.campaign.dask_pool import DaskWorkerPool

        pool = DaskWorkerPool(cluster, plan.out)
        size = pool.size
    with show(plan) as listener:
        return run_campaign(plan, pool, size, listener)


def _print_plan(plan: Plan, size: int, *, as_json: bool) -> None:
    import shutil

    complete = sum(bool(r.status) for r in plan.runs)
    facts: dict[str, Any] = {
        "runs": len(plan.runs),
        "complete": complete,
        "to_run": plan.count("run"),
        "references": plan.references,
        "references_to_run": plan.count("robot_alone") + plan.count("crowd_alone"),
        "jobs": size,
        "seconds": round(plan.seconds / size, 1),
        "bytes": round(plan.size),
        "out": str(plan.out),
    }
    if as_json:
        typer.echo(json.dumps(facts, indent=2))
        return
    root = next(p for p in (plan.out, *plan.out.parents) if p.exists())
    free = shutil.disk_usage(root).free
    typer.echo(f"runs        {facts['runs']}, {complete} complete, {facts['to_run']} to run")
    typer.echo(f"references  {facts['references']}, {facts['references_to_run']} to run")
    typer.echo(f"time        about {plan.seconds / size / 60.0:.1f} min with {size} processes")
    typer.echo(f"disk        about {plan.size / 1e9:.2f} GB, {free / 1e9:.0f} GB free")


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
