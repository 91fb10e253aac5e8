"""What ``run.json`` looks like: names, types and ranges, for records that somebody else wrote."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from annotated_types import Ge, Le, Len
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from crowdbot.core.types.ending import COMPLETE, Ending

Hash = Annotated[str, Field(min_length=1, max_length=200)]
Count = Annotated[int, Ge(0), Le(2**63 - 1)]
Seconds = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


def _complete(ending: Ending) -> Ending:
    if not ending.complete:
        raise ValueError(f"a complete run ends as {', '.join(COMPLETE)}")
    return ending


Status = Annotated[Ending, Field(strict=False), AfterValidator(_complete)]


class _Part(BaseModel):
    model_config = ConfigDict(extra="allow", strict=True, frozen=True)


class PlannerPart(_Part):
    """Who drove; its parameters stand beside these."""

    kind: str
    name: str
    label: str


class HashesPart(_Part):
    """Of the scenario, its people and what happened."""

    spec: Hash
    realisation: Hash
    trajectory: Hash


class PluginPart(_Part):
    """One plugin that was loaded."""

    name: str
    distribution: str
    pinned: bool


class MetricPart(_Part):
    """Version of a metric; its parameters stand beside it."""

    spec_version: Annotated[int, Ge(0)]


class RobotPart(_Part):
    """One of several robots."""

    planner: PlannerPart
    status: Status
    reason: str
    goal_time: Seconds | None
    sim_time: Seconds
    trajectory: Hash
    toppled_time: Seconds | None = None
    clamped_commands: Count = 0
    planner_step_time: dict[str, float] = {}


class MomentPart(_Part):
    """When a run is worst."""

    t: Seconds
    what: Annotated[str, Field(max_length=100)]
    clearance: Annotated[float, Field(allow_inf_nan=False)] | None = None


class RecordModel(_Part):
    """The record of one complete run; keys that are not here are nobody's business."""

    run_id: Hash
    scenario: str
    suite: str
    planner: PlannerPart
    seed: Count
    hashes: HashesPart
    versions: dict[str, str]
    plugins: list[PluginPart]
    pinned: bool
    privileged: bool
    status: Status
    goal_time: Seconds | None
    metrics: dict[str, MetricPart]
    references: dict[str, str]
    machine: dict[str, str]
    reason: str
    sim_time: Seconds
    wall_time: Seconds
    planner_process: Literal["own", "in_process"] = "in_process"
    role: Literal["floor", "baseline", "ceiling", "candidate"] = "candidate"
    recorded: Literal["all", "used", "none"] = "all"
    agents: Literal["locked", "drawn", "none"] = "none"
    axes: dict[str, str] = {}
    axis_words: dict[str, Annotated[list[str], Len(2, 2)]] = {}
    suite_metrics: list[str] = []
    worst_moment: MomentPart | None = None
    conditions: dict[str, str] = {}
    reference_hashes: dict[str, Hash] = {}
    allowed_plugins: list[str] | None = None
    position: Count = 0
    density: float | None = None
    files: dict[str, Count] = {}
    cpu_time: Seconds = 0.0
    real_time_factor: float = 0.0
    toppled_time: Seconds | None = None
    clamped_commands: Count = 0
    planner_step_time: dict[str, float] = {}
    robots: dict[str, RobotPart] = {}


def record_problems(record: Mapping[str, Any]) -> list[str]:
    """Everything in a record that has the wrong type or is missing: where, and what is wanted."""
    try:
        RecordModel.model_validate(dict(record))
    except ValidationError as error:
        return [_said(e["loc"], e["msg"]) for e in error.errors(include_url=False)]
    except RecursionError:
        return ["it is nested too deep"]
    return []


def _said(place: tuple[int | str, ...], message: str) -> str:
    where = ".".join(str(part)[:60] for part in place)
    return f"'{where}': {message[:1].lower()}{message[1:]}"
