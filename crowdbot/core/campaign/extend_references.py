"""Extends reference scores by further runs, without making again those that are there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from crowdbot.core.campaign.plan import Plan
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow


def without_known(plan: Plan, known: Iterable[RunRow]) -> Plan:
    """Return a plan without the runs that references have of the same scenario.

    Calibration runs that no other run needs go, too.
    """
    there = {(r.suite, r.scenario, r.planner, r.seed, r.spec_hash) for r in known}
    runs = [
        job
        for job in plan.jobs
        if job.kind == "run"
        and (job.suite, job.scenario, job.label, job.seed, job.spec_hash) not in there
    ]
    keys = {job.key for job in runs}
    needed = {key for job in runs for key in job.depends_on}
    jobs = (job for job in plan.jobs if job.key in keys | needed)
    done = (run for run in plan.runs if run.record is not None or run.key in keys)
    return replace(plan, runs=tuple(done), jobs=tuple(jobs))


def extended(old: Results, new: Results) -> Results:
    """Return both; a new run takes the place of an old one of its scenario, planner and seed."""
    places = {run.directory for run in new.runs}
    kept = [run for run in old.runs if run.directory not in places]
    ids = {run.run_id for run in kept}
    scores = [score for score in old.scores if score.run_id in ids]
    return Results(runs=(*kept, *new.runs), scores=(*scores, *new.scores))
