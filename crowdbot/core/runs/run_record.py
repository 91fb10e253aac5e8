"""RunRecord: the facts about a run, as written to ``run.json``, read and hashed."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from annotated_types import Len
from pydantic import Field, ValidationError

import crowdbot.core.runs.record_parts as record_parts
from crowdbot.core.planning.containment.offer import ALL, Aspect
from crowdbot.core.runs import run_directory as files
from crowdbot.errors import InputError

#: Kind of planner of a run in which a person held the stick.
BY_PERSON = "teleop"


class RunIdentity(record_parts.RecordPart):
    """Everything that determines the course of a run.

    Attributes:
        step_budget: s, where one was given.
        planner_memory: bytes or None, where it is not the usual.
        duration: s, in a run of people alone.
        replace_draws: how many draws might be replaced, if any.
    """

    scenario: record_parts.Identity[str]
    suite: record_parts.Identity[str]
    planner: record_parts.Identity[record_parts.PlannerPart]
    step_budget: record_parts.Identity[int | float | None] = None
    planner_memory: record_parts.Identity[int | None] = None
    duration: record_parts.Identity[int | float] = 0.0
    replace_draws: record_parts.Identity[record_parts.Count] = 0
    seed: record_parts.Identity[record_parts.Count]
    hashes: record_parts.Identity[record_parts.IdentityHashes]
    versions: record_parts.Identity[dict[str, str]]
    plugins: record_parts.Identity[list[record_parts.PluginPart]]


class _Record(record_parts.CostPart):
    """A record that is stored in the directory of its run."""

    run_id: record_parts.Hash
    files: dict[str, record_parts.Count] = Field(default_factory=dict)
    digests: dict[str, record_parts.Hash] = Field(default_factory=dict)

    @classmethod
    def parse(cls, document: Mapping[str, Any], source: object) -> Self:
        """Return the record that a document holds.

        Raises:
            InputError: something is missing or malformed; it begins with ``source``.
        """
        try:
            return cls.model_validate(dict(document))
        except (ValidationError, RecursionError) as error:
            raise InputError(f"{source}: {_described(error)[0]}") from None

    @classmethod
    def read(cls, directory: Path) -> Self:
        """Return the record of the complete run in a directory.

        Raises:
            InputError: it cannot be read, or is malformed.
        """
        return cls.parse(files.checked_record(directory), directory / files.RECORD)

    @classmethod
    def find(cls, directory: Path) -> Self | None:
        """Return the record of the complete run in a directory; None if it cannot be read."""
        try:
            return cls.read(directory)
        except InputError:
            return None

    def write(self, directory: Path) -> None:
        """Write it into a directory.

        Raises:
            InputError: it cannot be written.
        """
        files.write_json(directory / files.RECORD, self.document())

    def document(self) -> dict[str, Any]:
        """Return the record as ``run.json`` has it."""
        return {"run_id": self.run_id, **super().document()}


class RunRecord(_Record, RunIdentity):
    """The record of one complete run; docs/reference/run_directory.md explains each key.

    A column of results is a field of this that is marked so, or a property of `RunRow`.
    """

    hashes: record_parts.Identity[record_parts.HashesPart]
    axes: dict[str, str] = Field(default_factory=dict)
    axis_words: dict[str, Annotated[list[str], Len(2, 2)]] = Field(default_factory=dict)
    position: record_parts.Count = 0
    altered: list[str] = Field(default_factory=list)
    agents: Literal["locked", "drawn", "none"] = "none"
    pinned: bool
    privileged: bool
    role: Literal["floor", "baseline", "ceiling", "adversary", "candidate"] = "candidate"
    planner_process: Literal["own", "in_process"] = "in_process"
    planner_contained: list[Aspect] | None = None
    allowed_plugins: list[str] | None = None
    recorded: Literal["all", "used", "none"] = "all"
    robots: dict[str, record_parts.RobotPart] = Field(default_factory=dict)
    excused: list[record_parts.ExcusedPart] = Field(default_factory=list)
    references: dict[str, str]
    reference_hashes: dict[str, record_parts.Hash] = Field(default_factory=dict)
    density: Annotated[float | None, record_parts.ResultColumn("REAL")] = None
    conditions: dict[str, str] = Field(default_factory=dict)
    crowd: str | None = None
    metrics: dict[str, record_parts.MetricPart]
    suite_metrics: list[str] = Field(default_factory=list)
    worst_moment: record_parts.MomentPart | None = None
    machine: dict[str, str]
    live: record_parts.LivePart | None = None

    @property
    def knows_truth(self) -> bool:
        """True if the planner gets information that no sensor can provide."""
        return self.privileged or self.planner.label.endswith("+privileged")

    @property
    def by_person(self) -> bool:
        """Return True if a person drove, alone or with an assistant: the run cannot be repeated."""
        return self.planner.kind == BY_PERSON

    @property
    def classed(self) -> Literal["privileged", "sensors only", "driven by a person"]:
        """Return the leaderboard class of the run."""
        if self.by_person:
            return "driven by a person"
        return "privileged" if self.knows_truth else "sensors only"

    @property
    def people_alone(self) -> bool:
        """True if the scenario has no robot."""
        return bool(self.duration)

    @property
    def trusted(self) -> bool:
        """True if planner and plugins all come from installed distributions."""
        return self.pinned and all(plugin.pinned for plugin in self.plugins)

    @property
    def uncontained(self) -> str:
        """Return the accesses that a planner's separate process was not denied; empty: none.

        Planners were not contained before records said so.
        """
        if self.planner_process == "in_process":
            return ""
        missing = [aspect for aspect in ALL if aspect not in (self.planner_contained or ())]
        return "" if not missing else "all" if len(missing) == len(ALL) else ", ".join(missing)

    @property
    def compared(self) -> dict[str, str]:
        """Conditions that must be equal in runs that are compared, name -> text."""
        parts = self.model_dump_json(exclude_unset=True, include={"metrics"})
        return {
            **self.conditions,
            **_metric_conditions(parts),
            **{f"versions.{name}": version for name, version in self.versions.items()},
            "processor": self.machine.get("processor", ""),
        }

    def __getitem__(self, key: str) -> Any:
        """Return a value by its key in ``run.json``; deprecated."""
        warnings.warn(
            f"record[{key!r}] is deprecated: use record.{key}, or record.document()",
            DeprecationWarning,
            stacklevel=2,
        )
        return self.document()[key]


@lru_cache(maxsize=64)
def _metric_conditions(record: str) -> Mapping[str, str]:
    """Return the conditions in a record's metrics; cached, since the runs of a campaign share them.

    Args:
        record: JSON with the key ``metrics`` only.
    """
    metrics = json.loads(record)["metrics"].items()
    return {f"metrics.{name}": json.dumps(part, sort_keys=True) for name, part in metrics}


class ReferenceIdentity(record_parts.RecordPart):
    """Everything that a calibration run depends on."""

    reference: record_parts.Identity[str]
    spec: record_parts.Identity[record_parts.Hash]
    versions: record_parts.Identity[dict[str, str]]
    plugins: record_parts.Identity[list[record_parts.PluginPart]] = Field(default_factory=list)
    planner: record_parts.Identity[dict[str, Any]] = Field(default_factory=dict)
    seed: record_parts.Identity[record_parts.Count] = 0
    step_budget: record_parts.Identity[int | float | None] = None
    planner_memory: record_parts.Identity[int | None] = None
    realisation: record_parts.Identity[str] = ""
    duration: record_parts.Identity[int | float] = 0.0


class ReferenceRecord(_Record, ReferenceIdentity):
    """The record of a calibration run."""


def record_problems(document: Mapping[str, Any]) -> list[str]:
    """Return all missing or invalid entries of a record: the path, and the expected type."""
    return _problems(RunRecord, document)


def _problems(model: type[record_parts.RecordPart], document: Mapping[str, Any]) -> list[str]:
    try:
        model.model_validate(dict(document))
    except (ValidationError, RecursionError) as error:
        return _described(error)
    return []


def _described(error: ValidationError | RecursionError) -> list[str]:
    if isinstance(error, RecursionError):
        return ["it is nested too deep"]
    return [_problem(e["loc"], e["msg"]) for e in error.errors(include_url=False)]


def _problem(place: tuple[int | str, ...], message: str) -> str:
    where = ".".join(str(part)[:60] for part in place)
    return f"'{where}': {message[:1].lower()}{message[1:]}"
