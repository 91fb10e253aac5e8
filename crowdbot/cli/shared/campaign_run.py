"""Run or print a plan, for `crowdbot campaign` and `crowdbot audit`."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from crowdbot.cli.output.say import say, say_json

if TYPE_CHECKING:
    from crowdbot.core.campaign.plan import Plan
    from crowdbot.core.campaign.run import State


def read_seeds(text: str) -> list[int]:
    """Parse ``0,1,2``, ``0..4``, or a mix of both.

    Raises:
        UsageError: the text is not in this format.
    """
    from crowdbot.errors import UsageError

    seeds: list[int] = []
    for part in text.split(","):
        found = re.fullmatch(r"\s*(\d{1,9})(?:\.\.(\d{1,9}))?\s*", part)
        if found is None or (found[2] and int(found[2]) < int(found[1])):
            raise UsageError(f"--seeds {text}: write 0,1,2 or 0..4")
        seeds += range(int(found[1]), int(found[2] or found[1]) + 1)
    return seeds


def worker_count(jobs: int) -> int:
    """Return the number of worker processes: ``jobs``, or one per core if it is 0."""
    from crowdbot.core.support.cores import available_cores

    return jobs or available_cores()


def run_plan(plan: Plan, size: int, cluster: str | None) -> State:
    """Execute missing runs, on this machine or a cluster, and show progress."""
    from crowdbot.cli.shared.campaign_view import show
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


def print_plan(plan: Plan, size: int, *, as_json: bool) -> None:
    """Print a plan's numbers of complete and missing runs, and estimates of time and disk space."""
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
        "left_out": dict(plan.left_out),
        "out": str(plan.out),
    }
    if as_json:
        say_json(facts)
        return
    root = next(p for p in (plan.out, *plan.out.parents) if p.exists())
    free = shutil.disk_usage(root).free
    say(f"runs        {facts['runs']}, {complete} complete, {facts['to_run']} to run")
    for label, why in plan.left_out.items():
        say(f"left out    {label}: {why}")
    say(f"references  {facts['references']}, {facts['references_to_run']} to run")
    say(f"time        about {plan.seconds / size / 60.0:.1f} min with {size} processes")
    say(f"disk        about {plan.size / 1e9:.2f} GB, {free / 1e9:.0f} GB free")
