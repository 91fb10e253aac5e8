"""Add runs to reference scores without repeating the existing ones."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from crowdbot.core.campaign.job import Job
from crowdbot.core.campaign.plan import Plan
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.support.json_digest import digest

_NAMES = ("name", "label")  # what a record adds to what defines a planner


def known_jobs(plan: Plan, known: Iterable[RunRow]) -> list[Job]:
    """Return the missing runs that the references hold: same scenario, planner and seed.

    A planner whose parameters have changed since counts as another one.
    """
    there = {(r.suite, r.scenario, r.spec_hash, r.seed, _planner_digest(r)) for r in known}
    return [
        job
        for job in plan.jobs
        if job.kind == "run"
        and (job.suite, job.scenario, job.spec_hash, job.seed, job.planner_digest) in there
    ]


def _planner_digest(run: RunRow) -> str:
    planner = run.record.document()["planner"]
    return digest({name: value for name, value in planner.items() if name not in _NAMES})


def without_known(plan: Plan, known: Iterable[RunRow]) -> Plan:
    """Return a plan without the runs that the references hold.

    Calibration runs that no other run needs are removed, too.
    """
    held = {job.key for job in known_jobs(plan, known)}
    runs = [job for job in plan.jobs if job.kind == "run" and job.key not in held]
    keys = {job.key for job in runs}
    needed = {key for job in runs for key in job.depends_on}
    jobs = (job for job in plan.jobs if job.key in keys | needed)
    done = (run for run in plan.runs if run.record is not None or run.key in keys)
    return replace(plan, runs=tuple(done), jobs=tuple(jobs))


def extended(old: Results, new: Results) -> Results:
    """Return both sets of runs; a new run replaces an old one of its scenario, planner and seed."""
    places = {run.directory for run in new.runs}
    kept = [run for run in old.runs if run.directory not in places]
    ids = {run.run_id for run in kept}
    scores = [score for score in old.scores if score.run_id in ids]
    return Results(runs=(*kept, *new.runs), scores=(*scores, *new.scores))
