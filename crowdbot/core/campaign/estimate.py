"""Estimated cost of a campaign: a rough model, corrected by finished runs."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

from crowdbot.core.campaign.job import Job, Kind
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import RunRecord

# Measured with the challenge's corridor and dwa on one core (docs/developers/performance.md): per
# simulated second, and per person in it. Only the ratios matter once there are runs.
_SECONDS = {"run": (0.035, 0.00027), "robot_alone": (0.035, 0.0), "crowd_alone": (0.002, 0.00007)}
_BYTES = {"run": (40e3, 1000.0), "robot_alone": (3e3, 0.0), "crowd_alone": (1e3, 480.0)}
#: Additional time of every job, s.
_START = 0.5
#: Share of the time limit after which robots that arrive have arrived.
_SHARE_OF_LIMIT = 0.6


@dataclass(slots=True)
class CostEstimate:
    """Time and space for jobs, adapted with every finished run.

    The ratio of measured to expected cost is kept per planner, and overall for planners without
    data.
    """

    _time: dict[str, list[float]] = field(default_factory=lambda: defaultdict(lambda: [0.0, 0.0]))
    _size: list[float] = field(default_factory=lambda: [0.0, 0.0])

    def learn(self, label: str, cost: float, took: float) -> None:
        """Update the estimate with a job that took ``took`` s where ``cost`` s were expected."""
        for name in (label, ""):
            self._time[name][0] += took
            self._time[name][1] += cost

    def learn_run(self, run: Path, record: RunRecord, people: int, limit: float) -> None:
        """Update the estimate with a completed run."""
        took = record.wall_time + _START
        self.learn(record.planner.label, expected_seconds("run", people, limit), took)
        try:
            size = (run / files.RECORDING).stat().st_size
        except OSError:
            return
        self._size[0] += size
        self._size[1] += expected_bytes("run", people, limit)

    def seconds(self, job: Job) -> float:
        """Return the expected time of a job, s on one core."""
        label = "" if job.kind == "crowd_alone" else job.label
        took, cost = self._time[label] if self._time[label][1] else self._time[""]
        return job.cost * (took / cost if cost else 1.0)

    def size(self, kind: Kind, people: int, limit: float) -> float:
        """Return the expected size of a job's files, bytes."""
        found, expected = self._size
        factor = found / expected if expected and kind == "run" else 1.0
        return expected_bytes(kind, people, limit) * factor


def expected_seconds(kind: Kind, people: int, limit: float) -> float:
    """Return the expected processor time of a job without data, s."""
    base, each = _SECONDS[kind]
    return _START + (base + each * people) * _simulated(kind, limit)


def expected_bytes(kind: Kind, people: int, limit: float) -> float:
    """Return the expected size of a recording without data, bytes."""
    base, each = _BYTES[kind]
    return (base + each * people) * _simulated(kind, limit)


def _simulated(kind: Kind, limit: float) -> float:
    return limit if kind == "crowd_alone" else _SHARE_OF_LIMIT * limit
