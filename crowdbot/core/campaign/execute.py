"""Execute jobs one by one in one process; loaded data stays for the next job."""

from __future__ import annotations

import errno
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

from crowdbot.core.campaign.job import Job, JobOutcome, SuiteSource
from crowdbot.core.campaign.population_cache import cached_population
from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.resolve import PlannerChoice, resolve_planner
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.identity import Populate, Prepared, prepare, references_of, run_identity
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scenarios.library import open_spec
from crowdbot.core.scenarios.with_crowds import with_crowds
from crowdbot.core.sim.references import make_reference
from crowdbot.core.support.json_digest import digest
from crowdbot.core.types.ending import has_failed
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import CrowdbotError, InputError, PlannerError, PluginError, SimulationError


def execute(
    job: Job,
    progress: Callable[[Progress], None] | None = None,
    on_hang: Callable[[], object] | None = None,
) -> JobOutcome:
    """Execute one job; any error is part of the result.

    Args:
        progress: called several times per simulated second.
        on_hang: called if a planner cannot be interrupted; should end the process.
    """
    begin = time.perf_counter()
    try:
        status = _execute(job, progress, on_hang)
    except Exception as error:
        return failed_job(job, error, time.perf_counter() - begin)
    return JobOutcome(key=job.key, status=status, wall_time=time.perf_counter() - begin)


def failed_job(job: Job, error: Exception, wall_time: float = 0.0) -> JobOutcome:
    """Return a job that ended with an exception."""
    known = isinstance(error, CrowdbotError)
    return JobOutcome(
        key=job.key,
        error=f"{type(error).__name__}: {error}",
        exit_code=error.exit_code if known else SimulationError.exit_code,  # type: ignore[attr-defined]
        traceback="".join(traceback.format_exception(error)),
        disk_full=not isinstance(error, PluginError) and _is_full_disk(error),
        wall_time=wall_time,
    )


def _is_full_disk(error: BaseException | None) -> bool:
    """Return True if an error, or what caused it, is a full disk or quota."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
            return True
        error = error.__cause__ or error.__context__
    return False


def _execute(
    job: Job,
    progress: Callable[[Progress], None] | None,
    on_hang: Callable[[], object] | None,
) -> str:
    request = replace(_request(job), progress=progress, on_hang=on_hang)
    registry, populate = _registry(job.source), _populate(job.source)
    prepared = prepare(
        request.scenario, registry, references=request.options.references, populate=populate
    )
    _check_loaded(job, request, prepared)
    if not request.choice.died and digest(request.choice.spec_dump) != job.planner_digest:
        raise InputError(f"{request.choice.origin}: the planner changed since the campaign began")
    if job.kind == "run":
        if prepared.run.spec != job.spec_hash:
            raise InputError(f"{job.source.spec} changed since the campaign began")
        from crowdbot.core.sim.simulate import make_run  # imports Drake

        return make_run(request, prepared).status
    for reference in references_of(request, prepared):
        if reference.run_id == job.key:
            there = None if job.options.force else reference.complete
            return there.status if there else make_reference(request, reference).status
    raise InputError(f"{job.source.spec} changed since the campaign began")


def _check_loaded(job: Job, request: Request, prepared: Prepared) -> None:
    """Refuse a run whose planner differs from the one in the campaign's plan.

    Raises:
        PlannerError: the planner's process died before it sent its description.
    """
    if not request.choice.died:
        return
    identity = run_identity(request, prepared.run).id()
    if job.key not in (identity, *(r.run_id for r in references_of(request, prepared))):
        raise PlannerError(request.choice.died)


def _request(job: Job) -> Request:
    registry = _registry(job.source)
    expansion = _open(job.source)
    scenario = expansion.scenarios[job.index] if job.index < len(expansion.scenarios) else None
    if scenario is None or scenario.id != job.scenario:
        raise InputError(f"{job.source.spec} changed since the campaign began")
    out = Path(job.out)
    request = Request(
        scenario=scenario,
        choice=_choice(job.planner, job.settings, job.source, job.options.place),
        registry=registry,
        seed=job.seed,
        out=out,
        options=replace(job.options, metrics=expansion.metrics),
        references_finished=True,
        entry=expansion.entry(scenario),
    )
    if job.options.retry_failed and job.kind == "run" and not job.options.force:
        there = RunRecord.find(request.directory)
        failed = there is not None and has_failed(there.status)
        return replace(request, options=replace(request.options, force=failed))
    return request


def _registry(source: SuiteSource) -> Registry:
    return _discovered(source.plugins, source.allowed)


@cache
def _discovered(plugins: tuple[str, ...], allowed: tuple[str, ...] | None) -> Registry:
    return discover(extra=[Path(p) for p in plugins], allow=allowed)


@cache
def _open(source: SuiteSource) -> Expansion:
    registry = _registry(source)
    return with_crowds(open_spec(source.spec, registry, source.overrides), source.crowds, registry)


@cache
def _populate(source: SuiteSource) -> Populate:
    del source  # each source has its own cache
    return cached_population()


def _choice(
    planner: str, settings: tuple[str, ...], source: SuiteSource, place: PlannerPlace
) -> PlannerChoice:
    """Load the planner once, or again if its process died, so that only one run fails."""
    key = (planner, settings, source, place)
    if key not in _loaded:
        choice = resolve_planner(planner, _registry(source), settings, place)
        if choice.died:
            return choice
        _loaded[key] = choice
    return _loaded[key]


_loaded: dict[tuple[str, tuple[str, ...], SuiteSource, PlannerPlace], PlannerChoice] = {}
