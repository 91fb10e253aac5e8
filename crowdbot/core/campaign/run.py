"""Run a campaign: execute jobs in order, record failures, and update the store."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace

from crowdbot.core.campaign.estimate import CostEstimate
from crowdbot.core.campaign.job import Job, JobOutcome
from crowdbot.core.campaign.plan import Plan
from crowdbot.core.campaign.worker_pool import RunningJob, WorkerPool
from crowdbot.core.results.failure import Failure, forget_failure, write_failure
from crowdbot.core.results.store import Store, index
from crowdbot.core.types.ending import Ending, has_failed
from crowdbot.dsl.suite.suite_entry import altered_suffix
from crowdbot.errors import InputError, PluginError, SimulationError

_LOOK = 0.25


@dataclass(slots=True)
class State:
    """Progress of a campaign: finished runs, jobs left, remaining time.

    Attributes:
        statuses: statuses of existing runs, by key; ``failed`` for failures.
        labels: planner of each run, by key.
        left: jobs that have not ended.
        busy: jobs that workers are executing.
        failures: failed jobs with their outcome.
        began: start in monotonic time, s.
        made: number of new runs.
    """

    plan: Plan
    estimate: CostEstimate
    statuses: dict[str, str]
    labels: dict[str, str]
    left: dict[str, Job]
    size: int
    busy: Sequence[RunningJob] = ()
    failures: dict[str, JobOutcome] = field(default_factory=dict)
    began: float = field(default_factory=time.monotonic)
    made: int = 0

    @property
    def remaining(self) -> float:
        """Return the estimated seconds remaining."""
        seconds = sum(self.estimate.seconds(job) for job in self.left.values())
        for at_work in self.busy:
            progress = at_work.progress
            if at_work.job.key in self.left and progress is not None:
                share = min(1.0, progress.t / progress.limit)
                seconds -= share * self.estimate.seconds(at_work.job)
        return max(0.0, seconds) / max(1, min(self.size, len(self.left)))

    @property
    def exit_code(self) -> int:
        """Return 0 if all runs exist; 3 if planners or plugins failed, 4 for other failures."""
        codes = {d.exit_code for d in self.failures.values()}
        if codes - {PluginError.exit_code}:
            return SimulationError.exit_code
        failed = codes or any(map(has_failed, self.statuses.values()))
        return PluginError.exit_code if failed else 0


Listener = Callable[[State, Job | None, JobOutcome | None], None]


def run_campaign(plan: Plan, pool: WorkerPool, size: int, listener: Listener) -> State:
    """Execute all missing jobs.

    Finished runs are kept if this function is interrupted.

    Args:
        plan: from `make_plan`.
        pool: worker pool; closed at the end.
        size: number of parallel jobs, for the estimate.
        listener: called at the start, with each finished job, and several times per second without
            one.

    Raises:
        InputError: the folder cannot be written, or a job found the disk full.
    """
    with ExitStack() as stack:
        stack.callback(pool.close)
        store = stack.enter_context(index(plan.out))
        _relabel(plan)
        store.synchronise()
        campaign = _Campaign(plan, pool, size, store)
        listener(campaign.state, None, None)
        while campaign.state.left:
            campaign.submit()
            listener(campaign.state, None, None)
            for job, done in campaign.take():
                listener(campaign.state, job, done)
        return campaign.state


class _Campaign:
    """The state of all jobs: ready, running and ended."""

    def __init__(self, plan: Plan, pool: WorkerPool, size: int, store: Store) -> None:
        self._pool, self._store, self._out = pool, store, plan.out
        jobs = {job.key: job for job in plan.jobs}
        self.state = State(
            plan=plan,
            estimate=plan.estimate,
            statuses={r.key: r.status for r in plan.runs if r.status},
            labels={r.key: r.label for r in plan.runs},
            left=jobs,
            size=size,
        )
        # A run may start once its calibration runs exist; others run meanwhile.
        self._queue = deque(j for j in jobs.values())
        self._ended: set[str] = set()
        self._axes = {r.key: r.axes for r in plan.runs}

    def submit(self) -> None:
        """Submit as many jobs as there are free slots."""
        for _ in range(self._pool.free_slots()):
            job = next((j for j in self._queue if self._ended.issuperset(j.depends_on)), None)
            if job is None:
                return
            self._queue.remove(job)
            self._pool.submit(job)

    def take(self) -> list[tuple[Job, JobOutcome]]:
        """Return finished jobs, and jobs that became impossible."""
        ended = []
        for done in self._pool.finished(_LOOK):
            job = self.state.left.get(done.key)
            if job is not None:
                ended += self._end(job, done)
        self.state.busy = self._pool.busy()
        return ended

    def _end(self, job: Job, done: JobOutcome) -> list[tuple[Job, JobOutcome]]:
        if done.disk_full:  # every further job would fail, and none of them is the planner's fault
            message = done.error.removeprefix(f"{InputError.__name__}: ")
            raise InputError(f"{message}; free some, and the same command goes on where it was")
        del self.state.left[job.key]
        self._ended.add(job.key)
        if done.error:
            return self._fail(job, done)
        self.state.estimate.learn(
            "" if job.kind == "crowd_alone" else job.label, job.cost, done.wall_time
        )
        if job.kind == "run":
            self.state.statuses[job.key] = done.status
            self.state.made += 1
            forget_failure(self._out / job.directory)
            self._store.add(job.directory)
        return [(job, done)]

    def _fail(self, job: Job, done: JobOutcome) -> list[tuple[Job, JobOutcome]]:
        self.state.failures[job.key] = done
        if job.kind == "run":
            self.state.statuses[job.key] = Ending.NO_RUN
            write_failure(self._out / job.directory, _failure(job, done, self._axes[job.key]))
            self._store.add_failure(job.directory)
        ended = [(job, done)]
        for other in [j for j in self.state.left.values() if job.key in j.depends_on]:
            self._queue.remove(other)
            because = replace(done, key=other.key, error=f"{job.title}: {done.error}")
            ended += self._end(other, because)
        return ended


def _failure(job: Job, done: JobOutcome, axes: dict[str, str]) -> Failure:
    return Failure(
        run_id=job.key,
        suite=job.suite + altered_suffix(job.altered),
        scenario=job.scenario,
        planner=job.label,
        seed=job.seed,
        position=job.index,
        error=done.error,
        traceback=done.traceback,
        exit_code=done.exit_code,
        axes=axes,
    )


def _relabel(plan: Plan) -> None:
    """Update axis labels in records, since a suite may rename axes without affecting runs."""
    for run in plan.runs:
        record = run.record
        if record is not None and (record.axes, record.position) != (run.axes, run.position):
            renamed = {"axes": run.axes, "position": run.position}
            record.model_copy(update=renamed).write(run.directory)
