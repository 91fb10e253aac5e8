"""The plan of a campaign: all its runs, existing ones, and missing jobs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.campaign.estimate import CostEstimate, expected_seconds
from crowdbot.core.campaign.job import Job, Kind
from crowdbot.core.campaign.population_cache import cached_population
from crowdbot.core.campaign.request import (
    CampaignRequest,
    PlannerEntry,
    SelectedSuite,
    open_planners,
    open_suites,
)
from crowdbot.core.campaign.sample import FLOOR_SCENARIOS, sample
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.identity import (
    Prepared,
    Reference,
    longest,
    prepare,
    references_of,
    reusable_record,
    run_identity,
)
from crowdbot.core.runs.run import Request
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.sim.preflight import preflight
from crowdbot.core.support.json_digest import digest
from crowdbot.core.types.ending import has_failed
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedRun:
    """A run that the campaign needs, with its status if it exists.

    Attributes:
        key: its id.
        status: status of the existing run; empty if it is missing or will be repeated.
        directory: absolute path.
        axes, position: values that its record should have.
        record: its record; None if the run does not exist.
    """

    key: str
    label: str
    status: str
    directory: Path
    axes: dict[str, str]
    position: int
    record: RunRecord | None = field(repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """The runs and jobs of a campaign.

    Attributes:
        out: absolute root of the results.
        runs: all runs of the campaign, existing or not.
        jobs: missing calibration runs, then missing runs, longest first; those of floors and
            ceilings that the user did not name come after all others.
        references: calibration runs of all runs, existing or not.
        estimate: cost estimate, adapted to existing runs.
        size: expected size of the jobs' files, bytes.
        left_out: planners added by role that some robot cannot run -> reason.
    """

    out: Path
    runs: tuple[PlannedRun, ...]
    jobs: tuple[Job, ...]
    references: int
    estimate: CostEstimate
    size: float
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """Return the expected time of all jobs on one core."""
        return sum(self.estimate.seconds(job) for job in self.jobs)

    def count(self, kind: Kind) -> int:
        """Return the number of missing jobs of a kind."""
        return sum(job.kind == kind for job in self.jobs)

    @property
    def labels(self) -> list[str]:
        """Return the planners' labels."""
        return list(dict.fromkeys(r.label for r in self.runs))


def make_plan(campaign: CampaignRequest, registry: Registry) -> Plan:
    """Open and check everything, and find missing runs, without writing.

    Raises:
        CrowdbotError: a suite, a scenario, a planner or a setting is wrong.
    """
    planners = open_planners(campaign, registry)
    builder = _PlanBuilder(campaign, registry, planners)
    for suite in open_suites(campaign, registry):
        builder.add(suite)
    return builder.plan()


class _PlanBuilder:
    """Goes through all runs and collects missing ones."""

    def __init__(
        self, campaign: CampaignRequest, registry: Registry, planners: Sequence[PlannerEntry]
    ) -> None:
        self._campaign, self._registry, self._planners = campaign, registry, planners
        self._out = campaign.out.resolve()
        self._estimate, self._size = CostEstimate(), 0.0
        self._runs: list[PlannedRun] = []
        self._jobs: dict[str, Job] = {}
        self._references: dict[str, bool] = {}
        self._left_out: dict[str, str] = {}
        self._populate = cached_population()

    def plan(self) -> Plan:
        jobs = sorted(self._jobs.values(), key=lambda j: (j.added, j.kind == "run", -j.cost))
        return Plan(
            out=self._out,
            runs=tuple(self._runs),
            jobs=tuple(jobs),
            references=len(self._references),
            estimate=self._estimate,
            size=self._size,
            left_out=self._left_out,
        )

    def add(self, suite: SelectedSuite) -> None:
        everything = [
            prepare(
                scenario,
                self._registry,
                references=self._campaign.options.references,
                populate=self._populate,
            )
            for scenario in suite.scenarios
        ]
        size = self._campaign.sample
        chosen = everything if size is None else sample(everything, size, suite.expansion.suite)
        few = [id(one) for one in sample(chosen, FLOOR_SCENARIOS, suite.expansion.suite)]
        for one in chosen:
            planners = [e for e in self._planners if not e.sampled or id(one) in few]
            for entry, request in self._requests(suite, one, planners):
                self._add(suite, one, entry, request)

    def _requests(
        self,
        suite: SelectedSuite,
        prepared: Prepared,
        planners: Sequence[PlannerEntry],
    ) -> Iterator[tuple[PlannerEntry, Request]]:
        scenario = prepared.run.scenario
        given = self._campaign.seeds
        seeds = suite.expansion.run_seeds if given is None else tuple(dict.fromkeys(given))
        for entry in planners:
            for seed in seeds[:1] if entry.sampled else seeds:
                request = Request(
                    scenario=scenario,
                    choice=entry.choice,
                    registry=self._registry,
                    seed=seed,
                    out=self._out,
                    entry=suite.expansion.entry(scenario),
                    options=self._campaign.options,
                )
                yield entry, request

    def _add(
        self, suite: SelectedSuite, prepared: Prepared, entry: PlannerEntry, request: Request
    ) -> None:
        key = run_identity(request, prepared.run).id()
        references = references_of(request, prepared)
        record = reusable_record(request, key, compared=bool(references))
        if record is not None:
            self._learn(request, record, prepared)
            failed = self._campaign.options.retry_failed and has_failed(record.status)
            if failed or self._campaign.options.force:
                record = None
        if record is None and not self._can_run(entry, request):
            return
        self._runs.append(
            PlannedRun(
                key=key,
                label=entry.choice.label,
                status="" if record is None else record.status,
                directory=request.directory,
                axes=dict(request.entry.axes),
                position=request.entry.position,
                record=record,
            )
        )
        for reference in references:
            self._references.setdefault(reference.run_id, False)
        if record is None:
            missing = [r for r in references if self._is_missing(suite, entry, request, r)]
            self._job("run", key, suite, entry, request, prepared, missing)

    def _can_run(self, entry: PlannerEntry, request: Request) -> bool:
        """Return True if the robot has the planner's sensors.

        Raise if the user named the planner.
        """
        try:
            preflight(request)
        except InputError as error:
            if not entry.optional:
                raise
            self._left_out.setdefault(entry.choice.label, str(error))
            return False
        return True

    def _is_missing(
        self, suite: SelectedSuite, entry: PlannerEntry, request: Request, reference: Reference
    ) -> bool:
        """Return True if a calibration run is missing, and add a job for it."""
        if reference.run_id not in self._jobs:
            there = reference.complete is not None and not self._campaign.options.force
            if self._references[reference.run_id] or there:
                self._references[reference.run_id] = True
                return False
            kind: Kind = "crowd_alone" if reference.name == "crowd_alone" else "robot_alone"
            self._job(kind, reference.run_id, suite, entry, request, reference, ())
        return True

    def _learn(self, request: Request, record: RunRecord, prepared: Prepared) -> None:
        people = len(prepared.run.people.agents)
        self._estimate.learn_run(request.directory, record, people, longest(request.scenario))

    def _job(
        self,
        kind: Kind,
        key: str,
        suite: SelectedSuite,
        entry: PlannerEntry,
        request: Request,
        planned: Prepared | Reference,
        depends_on: Sequence[Reference],
    ) -> None:
        trial = planned.run if isinstance(planned, Prepared) else planned.trial
        directory = request.directory if isinstance(planned, Prepared) else planned.directory
        people = len(trial.people.agents)
        self._size += self._estimate.size(kind, people, longest(request.scenario))
        self._jobs[key] = Job(
            key=key,
            kind=kind,
            source=suite.source,
            suite=request.entry.suite,
            scenario=request.scenario.id,
            index=request.entry.position,
            spec_hash=trial.spec,
            planner_digest=digest(entry.choice.spec_dump),
            planner=entry.text,
            settings=entry.settings,
            label=entry.choice.label,
            seed=request.seed,
            out=str(self._out),
            directory=directory.relative_to(self._out).as_posix(),
            options=request.options,
            depends_on=tuple(r.run_id for r in depends_on),
            cost=expected_seconds(kind, people, longest(request.scenario)),
            altered=tuple(request.entry.altered),
            added=entry.sampled,
        )
