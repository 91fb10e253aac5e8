"""Parts of records of runs and calibration runs: types, ranges, and fields of their identity."""

from __future__ import annotations

from typing import Annotated, Any, Literal, NamedTuple, TypeVar

from annotated_types import Ge, Le
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from crowdbot.core.support.json_digest import digest
from crowdbot.core.types.ending import COMPLETE, Ending

T = TypeVar("T")
_IDENTITY = "identity"
#: A field that decides what happens in a run: its id is the hash of all of these.
Identity = Annotated[T, _IDENTITY]


class ResultColumn(NamedTuple):
    """Marks a field of a run's record that is a column of results, with its type in SQL."""

    kind: Literal["REAL", "INTEGER", "BOOLEAN", "TEXT"]


Hash = Annotated[str, Field(min_length=1, max_length=200)]
Count = Annotated[int, Ge(0), Le(2**63 - 1)]
Seconds = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


def _complete(ending: Ending) -> Ending:
    if not ending.complete:
        raise ValueError(f"a run that is complete must end as {', '.join(COMPLETE)}")
    return ending


Status = Annotated[Ending, Field(strict=False), AfterValidator(_complete)]


class RecordPart(BaseModel):
    """A part of a record; keys that it does not know are kept."""

    model_config = ConfigDict(extra="allow", strict=True, frozen=True)

    def document(self) -> dict[str, Any]:
        """Return the part as JSON values, without defaults."""
        return self.model_dump(mode="json", exclude_unset=True)

    @classmethod
    def columns(cls) -> dict[str, str]:
        """Return the fields marked as columns of results, and their types in SQL."""
        fields = cls.model_fields.items()
        return {n: m.kind for n, f in fields for m in f.metadata if isinstance(m, ResultColumn)}

    def identity(self) -> dict[str, Any]:
        """Return the fields marked as identity, as JSON values; all fields if none is marked."""
        marked = [n for n, field in type(self).model_fields.items() if _IDENTITY in field.metadata]
        if not marked:
            return self.document()
        found = {n: getattr(self, n) for n in marked if n in self.model_fields_set}
        return {n: _identity_of(value) for n, value in found.items()}

    def id(self) -> str:
        """Return the hash of the identity."""
        return digest(self.identity())


class PlannerPart(RecordPart):
    """The planner; its parameters are further keys of the record.

    Attributes:
        sha256: of the file of a planner that comes from no plugin.
    """

    kind: str
    name: str
    label: str
    sha256: str = ""


class IdentityHashes(RecordPart):
    """Hashes of the scenario and of its people, as they are known before the run."""

    spec: Identity[Hash]
    realisation: Identity[Hash]


class HashesPart(IdentityHashes):
    """Hashes known before the run, and the hash of its trajectory."""

    trajectory: Hash


class PluginPart(RecordPart):
    """One plugin that was loaded; ``sha256`` of its files where it is not pinned."""

    name: str
    distribution: str
    pinned: bool
    sha256: str = ""


class MetricPart(RecordPart):
    """Version of a metric; its parameters are additional keys."""

    spec_version: Annotated[int, Ge(0)]


class EndedPart(RecordPart):
    """Ending of a run, or of one of its robots."""

    status: Status
    reason: Annotated[str, ResultColumn("TEXT")]
    goal_time: Annotated[Seconds | None, ResultColumn("REAL")]
    toppled_time: Seconds | None = None
    sim_time: Annotated[Seconds, ResultColumn("REAL")]
    planner_step_time: dict[str, float] = Field(default_factory=dict)
    clamped_commands: Count = 0


class CostPart(EndedPart):
    """Ending of a whole run, with its computing time."""

    wall_time: Annotated[Seconds, ResultColumn("REAL")]
    cpu_time: Seconds = 0.0
    real_time_factor: float = 0.0


class RobotPart(EndedPart):
    """Planner and trajectory's hash of one robot, in a run of several."""

    planner: PlannerPart
    trajectory: Hash


class MomentPart(RecordPart):
    """The moment at which a run is worst."""

    t: Seconds
    what: Annotated[str, Field(max_length=100)]
    clearance: Annotated[float, Field(allow_inf_nan=False)] | None = None


class StopPart(RecordPart):
    """The moment at which a person released the stick, which was then centred."""

    t: Seconds
    why: Annotated[str, Field(max_length=100)]


class WaitPart(StopPart):
    """An interval of real time, s, in which a run was paused until a person was back."""

    seconds: Seconds


class LatencyPart(RecordPart):
    """From a person's key to the step that used it, as the page measured it, ms."""

    count: Count
    median: Seconds
    p95: Seconds


class ExcusedPart(RecordPart):
    """A draw in which the robot was struck from behind without fault and toppled; not counted.

    Attributes:
        draw: its number; 0 is the scenario's own.
        person: number of the person.
        struck_time, toppled_time: s.
        realisation, trajectory: hashes of its people, and of what happened.
    """

    draw: Count
    person: int
    struck_time: Seconds
    toppled_time: Seconds
    realisation: Hash
    trajectory: Hash


class LivePart(RecordPart):
    """Data that only live runs have; times in s.

    Attributes:
        largest_lag: of runs by ``crowdbot serve`` in real time.
        stops, waits, delayed, latency: of runs with a person in a page: when the hand left the
            stick, when the run waited, the real time lost to a slow computer, and the latency.
    """

    steps: Count
    missed_steps: Count
    refused_commands: Count
    largest_lag: float | None = None
    stops: list[StopPart] = Field(default_factory=list)
    waits: list[WaitPart] = Field(default_factory=list)
    delayed: Seconds = 0.0
    latency: LatencyPart | None = None


def _identity_of(value: Any) -> Any:
    if isinstance(value, RecordPart):
        return value.identity()
    if isinstance(value, list):
        return [_identity_of(one) for one in value]
    return value
