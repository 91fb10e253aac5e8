"""The rows of a campaign's results: runs, scores, failures and damaged runs, as plain values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

#: What is known of an attempt that left no run: its robot did not arrive.
WITHOUT_RUN: Mapping[str, float] = {
    "success": 0.0,
    "success_no_collision": 0.0,
    "safe_efficiency": 0.0,
}

_PLACES = {"own": "own process", "in_process": "in the simulator's process"}


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRow:
    """One complete run.

    Attributes:
        run_id: hash of everything that decides what happens in it.
        suite, scenario, planner, seed: planner is the label, with a digest of its parameters
            where they are not the defaults.
        axes: axis of the suite -> label, such as ``{"flow": "counter", "density": "d0250"}``,
            in the suite's order; ``draw`` among them where a condition has several.
        status: the word of an `Ending`; ``reason`` says why it ended.
        goal_time: s, None when the robot did not arrive.
        sim_time, wall_time: s.
        privileged: the planner was told what no sensor can tell.
        pinned: every plugin and the planner came from an installed distribution.
        spec_hash, realisation_hash, trajectory_hash: runs with equal ``realisation_hash`` share
            one drawn crowd: the cluster of the statistics.
        density: mean number of people present for each m² of the crowd's area, 1/m²; None
            without people.
        directory: of the run, relative to the results' root.
        conditions: what must be equal in runs that are compared: rates, perceived radius, whether
            people see the robot, versions of software, parameters of metrics. Name -> text.
        record: the whole ``run.json``.
        role: what the planner is there for: floor, baseline, ceiling or candidate.
    """

    run_id: str
    suite: str
    scenario: str
    planner: str
    seed: int
    axes: Mapping[str, str]
    status: str
    reason: str
    goal_time: float | None
    sim_time: float
    wall_time: float
    privileged: bool
    pinned: bool
    spec_hash: str
    realisation_hash: str
    trajectory_hash: str
    density: float | None
    directory: str
    conditions: Mapping[str, str]
    record: Mapping[str, Any] = field(default_factory=dict, repr=False)
    role: str = "candidate"

    @property
    def planner_process(self) -> str:
        """As `process_of` says it."""
        return process_of(self.record)


def process_of(record: Mapping[str, Any]) -> str:
    """Where the planner of a run ran: ``own``, or ``in_process``, inside the simulator.

    Args:
        record: ``run.json``; those before planners had processes do not say it.
    """
    return "own" if record.get("planner_process") == "own" else "in_process"


def named_metrics(runs: Iterable[RunRow]) -> list[str]:
    """Metrics that the suites of some runs name, in their order; each once."""
    found: dict[str, None] = {}
    for run in runs:
        named = run.record.get("suite_metrics")
        found.update(dict.fromkeys(map(str, named)) if isinstance(named, list) else {})
    return list(found)


def processes(records: Iterable[Mapping[str, Any]]) -> str:
    """Where the planner of some runs ran, in words."""
    return " or ".join(sorted({_PLACES[process_of(record)] for record in records}))


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreRow:
    """One line of a run's ``scores.csv``.

    Attributes:
        value: None unless ``status`` is ``ok``.
        better: ``higher``, ``lower``, ``reference`` (nearer to the reference run) or ``none``.
        status: ``ok``, ``undefined`` or ``censored``; ``reason`` says why.
        lower, upper: bounds of a censored value.
    """

    run_id: str
    category: str
    metric: str
    symbol: str
    variant: str
    value: float | None
    unit: str
    better: str
    status: str
    reason: str
    lower: float | None
    upper: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class FailureRow:
    """A run that a campaign could not make, with what Python said; ``axes`` as in `RunRow`."""

    suite: str
    scenario: str
    planner: str
    seed: int
    axes: Mapping[str, str] = field(default_factory=dict)
    error: str
    traceback: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DamagedRun:
    """A run that is left out, because something of it is missing, cut or malformed.

    Attributes:
        directory: relative to the results' root.
        reason: what is wrong with it.
    """

    directory: str
    reason: str
