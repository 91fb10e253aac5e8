"""What a campaign is going to take: a rough model, corrected by the runs that are there."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.campaign.job import Job, Kind
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord

# Measured with the challenge's corridor and dwa on one core (docs/reference/performance.md): per
# simulated second, and for each person in it. Only their proportions matter once runs are there.
_SECONDS = {"run": (0.035, 0.00027), "robot_alone": (0.035, 0.0), "crowd_alone": (0.002, 0.00007)}
_BYTES = {"run": (40e3, 1000.0), "robot_alone": (3e3, 0.0), "crowd_alone": (1e3, 480.0)}
#: What every job takes besides, s.
_START = 0.5
#: Robots that arrive do so long before the time limit.
_SHARE_OF_LIMIT = 0.6


@dataclass(slots=True)
class CostEstimate:
    """Time and space for jobs; learns from every run that it is shown.

    The proportion of what was measured to what was expected is kept for each planner, and one
    for all of them together for a planner that nothing is known of.
    """

    _time: dict[str, list[float]] = field(default_factory=lambda: defaultdict(lambda: [0.0, 0.0]))
    _size: list[float] = field(default_factory=lambda: [0.0, 0.0])

    def learn(self, label: str, cost: float, took: float) -> None:
        """A job of a planner took so many seconds where ``cost`` were expected."""
        for name in (label, ""):
            self._time[name][0] += took
            self._time[name][1] += cost

    def learn_run(self, run: Path, record: RunRecord, people: int, limit: float) -> None:
        """A run that is complete."""
        took = record.wall_time + _START
        self.learn(record.planner.label, expected_seconds("run", people, limit), took)
        try:
            size = (run / files.RECORDING).stat().st_size
        except OSError:
            return
        self._size[0] += size
        self._size[1] += expected_bytes("run", people, limit)

    def seconds(self, job: Job) -> float:
        """What a job is going to take, s on one core."""
        label = "" if job.kind == "crowd_alone" else job.label
        took, cost = self._time[label] if self._time[label][1] else self._time[""]
        return job.cost * (took / cost if cost else 1.0)

    def size(self, kind: Kind, people: int, limit: float) -> float:
        """What it is going to leave, bytes."""
        found, expected = self._size
        factor = found / expected if expected and kind == "run" else 1.0
        return expected_bytes(kind, people, limit) * factor


def expected_seconds(kind: Kind, people: int, limit: float) -> float:
    """Processor time of a job before anything was measured, s."""
    base, each = _SECONDS[kind]
    return _START + (base + each * people) * _simulated(kind, limit)


def expected_bytes(kind: Kind, people: int, limit: float) -> float:
    """Size of a recording before anything was measured."""
    base, each = _BYTES[kind]
    return (base + each * people) * _simulated(kind, limit)


def _simulated(kind: Kind, limit: float) -> float:
    return limit if kind == "crowd_alone" else _SHARE_OF_LIMIT * limit
