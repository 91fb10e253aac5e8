"""Record people alone, without Drake; and shared parts of all recordings."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as crowd_state
from crowdbot.core.crowd.desired_acceleration import candidates_of
from crowdbot.core.environments.build import build_environment
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.recording.header import AgentsHeader, RecordingHeader
from crowdbot.core.recording.motion.candidates import CandidateGroup
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.watcher import Watcher
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs.identity import Trial
from crowdbot.core.runs.outcome import Outcome, Progress
from crowdbot.core.runs.run import OnBegin, OnCrowd, Request
from crowdbot.core.runs.run_options import USUAL, RunOptions
from crowdbot.core.sim.build_crowd import build_crowd
from crowdbot.core.sim.crowd_only import run_crowd
from crowdbot.core.sim.loggers.watched_run import WatchedRun
from crowdbot.core.types.ending import Ending
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class RunSetup:
    """The setup of one recording; ``hashes`` identify its run in its header.

    ``on_begin`` and ``on_crowd`` are as in `Request`.
    """

    scenario: Scenario
    agents: Realisation
    registry: Registry
    choice: PlannerChoice
    seed: int
    recording: Path
    stage: str
    progress: Callable[[Progress], None] | None
    stop: Callable[[], bool]
    on_hang: Callable[[], object] | None
    options: RunOptions = USUAL
    hashes: Mapping[str, str] = field(default_factory=dict)
    watchers: Sequence[Watcher] = ()
    on_begin: OnBegin | None = None
    on_crowd: OnCrowd | None = None

    @classmethod
    def of(cls, request: Request, trial: Trial, **own: Any) -> RunSetup:
        """Return the setup of a recording for a request.

        Args:
            trial: its scenario and people.
            own: fields that the request does not give, or gives otherwise.
        """
        same = ("registry", "choice", "seed", "options", "progress", "stop", "on_hang", "on_begin")
        given = {name: getattr(request, name) for name in same}
        people = trial.people.agents
        return cls(**{**given, "scenario": trial.scenario, "agents": people, **own})


def record_crowd(setup: RunSetup, duration: float) -> Outcome:
    """Simulate the scenario's people without a robot.

    Raises:
        InputError: there are no people.
    """
    scenario, registry = setup.scenario, setup.registry
    parts = build_environment(registry, scenario.environment)
    engine = build_crowd(scenario, setup.agents, parts, registry)
    if engine is None:
        raise InputError(f"{scenario.id} has no crowd")
    header = RecordingHeader(
        scenario=scenario.id, hashes=setup.hashes, agents=agents(engine), walls=parts.walls
    )
    begin, cpu = time.perf_counter(), time.process_time()
    now = 0.0

    def report(t: float) -> None:
        nonlocal now
        now = t
        if setup.progress is not None and t == int(t):
            factor = t / max(time.perf_counter() - begin, 1e-9)
            setup.progress(Progress(setup.stage, t, duration, factor, None))

    with recording(setup, header, engine) as (writer, ending):
        watched = WatchedRun(setup.watchers, header, {}, {}).watch("", people=True)
        log = RunLog(
            writer, ids(engine), robot=None, goal_column=engine.goal_column, on_sample=watched
        )
        if setup.on_crowd is not None:
            setup.on_crowd(engine, writer.signal)
        whole = run_crowd(
            engine, log, duration, scenario.rates.log, on_sample=report, stop=setup.stop
        )
        outcome = Outcome(
            status=Ending.TIMEOUT if whole else Ending.INTERRUPTED,
            reason=f"ran for {duration:g} s" if whole else "interrupted by the user",
            goal_time=None,
            sim_time=now,
            wall_time=time.perf_counter() - begin,
            cpu_time=time.process_time() - cpu,
        )
        ending.append(outcome)
    return replace(outcome, written=writer.written)


@contextmanager
def recording(
    setup: RunSetup, header: RecordingHeader, engine: CrowdEngine | None, description: str = ""
) -> Iterator[tuple[RecordingWriter, list[Outcome]]]:
    """Yield a writer that is always closed; the context appends the outcome."""
    writer = RecordingWriter(
        setup.recording,
        header,
        record=setup.options.record,
        choosers=choosers(engine),
        description=description,
    )
    ending: list[Outcome] = []
    try:
        yield writer, ending
    finally:
        last = ending[0] if ending else None
        status = last.status if last else Ending.INTERRUPTED
        goal_time = last.goal_time if last else None
        writer.close(goal_time, status != Ending.INTERRUPTED, status)


def ids(engine: CrowdEngine | None) -> NDArray[np.int64]:
    """Return (N,) ids of the people; empty without an engine."""
    return np.zeros(0, np.int64) if engine is None else engine.agents.id


def agents(engine: CrowdEngine | None) -> AgentsHeader | None:
    """Return a recording's data about people; None without an engine."""
    if engine is None:
        return None
    a = engine.agents
    return AgentsHeader(id=a.id, radius=a.radius, mass=a.mass)


def choosers(engine: CrowdEngine | None) -> list[CandidateGroup]:
    """Return people whose motion follows from known candidate velocities.

    Empty without an engine, and with steering parts: these change every velocity that is chosen.
    """
    if engine is None or engine.steers:
        return []
    a, groups = engine.agents, list[CandidateGroup]()
    for number, policy in enumerate(engine.policies):
        candidates = candidates_of(policy)
        rows = np.flatnonzero(a.policy == number)
        if candidates is not None and len(rows):
            groups.append(
                CandidateGroup(
                    candidates=candidates,
                    rows=rows,
                    preferred_speed=a.preferred_speed[rows],
                    radius=a.radius[rows],
                    max_acceleration=a.max_acceleration[rows],
                )
            )
    return groups


def goal_column_of(engine: CrowdEngine | None) -> int:
    """Return the first column of people's waypoints in the crowd's state."""
    return crowd_state.GOAL_X if engine is None else engine.goal_column
