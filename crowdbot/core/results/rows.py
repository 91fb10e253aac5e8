"""Rows of a campaign's results: runs, scores, failures and damaged runs, as plain values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter
from typing import Any, Generic, TypeVar, cast

from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.types.ending import Ending
from crowdbot.dsl.suite.suite_entry import altered_digest, altered_suffix

#: Known scores of an attempt without a run: its robot did not arrive.
WITHOUT_RUN: Mapping[str, float] = {
    "success": 0.0,
    "success_no_collision": 0.0,
    "safe_efficiency": 0.0,
}

T = TypeVar("T")

_PLACES = {"own": "own process", "in_process": "in the simulator's process"}


class OfRecord(Generic[T]):
    """An attribute of a `RunRow` that is one of its record; a path of names, joined by dots."""

    def __init__(self, path: str) -> None:
        self._read = attrgetter(path)

    def __get__(self, row: RunRow | None, _: type) -> T:
        return cast(T, self if row is None else self._read(row.record))


@dataclass(frozen=True, kw_only=True)
class RunRow:
    """One complete run: a view of its record.

    Columns of the record that code reads are declared here with their types; the others are
    attributes, too.

    Attributes:
        record: contents of its ``run.json``.
        directory: of the run, relative to the results' root.
        entry: of a leaderboard: the name that its planner has there.
    """

    record: RunRecord = field(repr=False)
    directory: str
    entry: str = ""

    #: Id of the scenario.
    scenario = OfRecord[str]("scenario")
    #: The seed of sensor noise and planner.
    seed = OfRecord[int]("seed")
    #: Axis of the suite -> label, in its order; ``draw`` where a condition has several.
    axes = OfRecord[Mapping[str, str]]("axes")
    #: The reason for which it ended.
    reason = OfRecord[str]("reason")
    #: Arrival time of the robot, s.
    goal_time = OfRecord[float | None]("goal_time")
    #: Simulated time, s.
    sim_time = OfRecord[float]("sim_time")
    #: True if the planner gets information that no sensor can provide.
    privileged = OfRecord[bool]("knows_truth")
    #: True if every plugin and the planner came from an installed distribution.
    pinned = OfRecord[bool]("trusted")
    #: Process of the planner: ``own``, or ``in_process``, inside the simulator.
    planner_process = OfRecord[str]("planner_process")
    #: True if a person drove the robot.
    by_person = OfRecord[bool]("by_person")
    #: Role of the planner: floor, baseline, ceiling or candidate.
    role = OfRecord[str]("role")
    #: Hash of the scenario.
    spec_hash = OfRecord[str]("hashes.spec")
    #: Hash of the drawn crowd; runs that share one are a cluster of the statistics.
    realisation_hash = OfRecord[str]("hashes.realisation")
    #: The hash of all simulated numbers.
    trajectory_hash = OfRecord[str]("hashes.trajectory")
    #: Mean number of people in the crowd's area, 1/m²; None without people.
    density = OfRecord[float | None]("density")
    #: Source of its people: ``locked``, ``drawn``, or ``none``.
    agents = OfRecord[str]("agents")
    #: Metrics that its suite names, in order.
    suite_metrics = OfRecord[Sequence[str]]("suite_metrics")
    #: Axis -> its title, and its label in words.
    axis_words = OfRecord[Mapping[str, Sequence[str]]]("axis_words")

    @property
    def run_id(self) -> str:
        """Return the hash of all that determines the run; in a leaderboard, of the entry, too."""
        own = self.record.run_id
        return f"{self.entry}\0{own}" if self.entry else own

    @property
    def suite(self) -> str:
        """Return the suite; runs of altered scenarios count as a suite of their own."""
        return self.record.suite + altered_suffix(self.record.altered)

    @property
    def changes(self) -> str:
        """Changes to the scenario, from ``--set``, in words; empty if there are none."""
        return ", ".join(self.record.altered) or altered_digest(self.record.scenario)

    @property
    def planner(self) -> str:
        """Return the label, with a digest of its parameters where they are not the defaults."""
        return self.entry or self.record.planner.label

    @property
    def status(self) -> str:
        """Return the word of its `Ending`; a run without a robot cannot time out."""
        return str(Ending.PEOPLE_ALONE if self.record.people_alone else self.record.status)

    @property
    def source(self) -> str:
        """Kind and digest of its planner, and of plugins of no installed version."""
        planner = self.record.planner
        digest = planner.sha256[:12]
        loose = [plugin for plugin in self.record.plugins if not plugin.pinned]
        beside = ", ".join(f"{p.distribution} sha256 {p.sha256[:12]}" for p in loose)
        return (
            f"{planner.kind}{f' sha256 {digest}' * bool(digest)}"
            f"{f', with the plugin {beside}' * bool(beside)}"
        )

    @property
    def replaced_draws(self) -> int:
        """Number of draws that were replaced before the one that counts; see `ExcusedPart`."""
        return len(self.record.excused)

    @property
    def crowd(self) -> str:
        """Return the fingerprint of the crowd's behaviour; empty without people."""
        return self.record.crowd or ""

    @property
    def moment(self) -> Sequence[Any] | None:
        """Time (s) and description of its most interesting moment."""
        found = self.record.worst_moment
        if found is None:
            return None
        known = "" if found.clearance is None else f", {found.clearance:.2f} m"
        return [round(found.t, 2), f"{found.what}{known}"]

    @cached_property
    def provenance(self) -> Mapping[str, Any]:
        """Return ``versions``, ``machine``, ``plugins``, ``planner``, ``process`` of the run.

        Each is a mapping of names to texts but ``process``, a text on where the planner ran.
        """
        record = self.record
        plugins = {p.name: p.distribution + ("" if p.pinned else ", not pinned")
                   for p in record.plugins}  # fmt: skip
        return {
            "versions": dict(record.versions),
            "machine": dict(record.machine),
            "plugins": plugins,
            "planner": flat_texts(record.planner.document()),
            "process": place_of(record),
        }

    @cached_property
    def conditions(self) -> Mapping[str, str]:
        """Conditions that must be equal in runs that are compared, name -> text."""
        return self.record.compared


for _name in RunRecord.columns().keys() - vars(RunRow).keys():
    setattr(RunRow, _name, OfRecord[Any](_name))

#: Columns of runs in ``results.sqlite``, CSV, Parquet and data frames: attribute -> type.
RUN_COLUMNS: Mapping[str, str] = {
    "suite": "TEXT",
    "scenario": "TEXT",
    "planner": "TEXT",
    "seed": "INTEGER",
    "status": "TEXT",
    **RunRecord.columns(),
    "privileged": "BOOLEAN",
    "pinned": "BOOLEAN",
    "planner_process": "TEXT",
    "spec_hash": "TEXT",
    "realisation_hash": "TEXT",
    "trajectory_hash": "TEXT",
    "run_id": "TEXT",
    "directory": "TEXT",
}


def named_metrics(runs: Iterable[RunRow]) -> list[str]:
    """Return metrics that the suites of some runs name, in order and without duplicates."""
    return list(dict.fromkeys(name for run in runs for name in run.suite_metrics))


def processes(places: Iterable[str]) -> str:
    """Describe where the planners of some runs ran, and which accesses they had there."""
    return " or ".join(sorted(set(places)))


def flat_texts(value: Any) -> dict[str, str]:
    """Return the values of nested mappings as texts, under names joined by dots."""
    if not isinstance(value, Mapping):
        return {}
    texts: dict[str, str] = {}
    for name, inner in value.items():
        if isinstance(inner, Mapping):
            texts |= {f"{name}.{k}": text for k, text in flat_texts(inner).items()}
        else:
            texts[str(name)] = str(inner)
    return texts


def place_of(record: RunRecord) -> str:
    """Describe where the planner of a run ran."""
    place, reached = _PLACES[record.planner_process], record.uncontained
    if not reached:
        return place
    return f"{place}, not contained" + ("" if reached == "all" else f" ({reached})")


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreRow:
    """One line of a run's ``scores.csv``.

    Attributes:
        value: None unless ``status`` is ``ok``.
        better: ``higher``, ``lower``, ``reference`` (nearer to the reference run) or ``none``.
        status: ``ok``, ``undefined`` or ``censored``; ``reason`` explains it.
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
class DamagedRun:
    """A run that is left out because a file is missing, truncated or malformed.

    Attributes:
        directory: relative to the results' root.
        reason: the error.
    """

    directory: str
    reason: str
