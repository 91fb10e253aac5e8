"""Explains runs: reads each recording, finds its decisive moment, counts causes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crowdbot.core.recording.recording import Recording
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.record_parts import EndedPart
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.ending import Ending
from crowdbot.core.why.causes import DECIDING, Cause
from crowdbot.core.why.decisive_moment import DecisiveMoment, decisive_moment
from crowdbot.core.why.sentences import what_happened, what_was_seen, why_late
from crowdbot.errors import InputError, UnknownNameError


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """A run's decisive moment, explained in sentences.

    Attributes:
        directory: of the run.
        ended: its ending, or that of the robot.
        run: what happened.
        sentences: the moment in words.
    """

    directory: Path
    record: RunRecord
    robot: str
    ended: EndedPart
    run: Trajectories
    moment: DecisiveMoment
    sentences: Sequence[str]

    @property
    def title(self) -> str:
        """Return scenario, planner, seed, and ending."""
        record = self.record
        one = f", robot {self.robot}" if self.robot else ""
        t = self.ended.goal_time if self.ended.goal_time is not None else self.ended.sim_time
        ended = self.ended.status.sentence.format(t=t)
        return f"{record.scenario} · {record.planner.label} · seed {record.seed}{one}: {ended}"

    @property
    def replay(self) -> Path | None:
        """Return the replay page, if there is one."""
        page = self.directory / files.REPLAY
        return page if page.is_file() else None

    def as_json(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        agent, crowd = self.moment.agent, self.run.agents
        return {
            "directory": str(self.directory),
            "scenario": self.record.scenario,
            "planner": self.record.planner.label,
            "seed": self.record.seed,
            "robot": self.robot or None,
            "status": str(self.ended.status),
            "reason": self.ended.reason,
            "cause": str(self.moment.cause),
            "t": round(self.moment.t, 4),
            "person": None if agent is None or crowd is None else int(crowd.id[agent]),
            "stood": round(self.moment.stood, 4),
            "sentences": list(self.sentences),
            "replay": None if self.replay is None else str(self.replay),
        }


def explain(directory: Path, robot: str | None = None, *, sensors: bool = True) -> Explanation:
    """Explain one run.

    Args:
        directory: of a complete run.
        robot: which of several robots.
        sensors: False to leave out what sensors saw and what the planner logged, which is quicker.

    Raises:
        InputError: there is no complete run, it has no robot, or several and none is named.
        UnknownNameError: there is no such robot.
    """
    record = RunRecord.read(directory)
    ended = _ended(record, robot, directory)
    with Recording(directory / files.RECORDING) as recording:
        run = recording.trajectories(robot)
        if run.robot is None:
            raise InputError(f"{directory}: there is no robot in this run")
        moment = decisive_moment(run, ended)
        sentences = what_happened(run, moment, ended.reason)
        if ended.status == Ending.TIMEOUT and moment.cause not in (Cause.BLOCKED, Cause.SLOW):
            sentences.append(why_late(run))
        if sensors:
            sentences += what_was_seen(run, moment, recording.scans(robot=robot))
    return Explanation(
        directory=directory, record=record, robot=robot or "", ended=ended, run=run, moment=moment,
        sentences=sentences,
    )  # fmt: skip


def _ended(record: RunRecord, robot: str | None, directory: Path) -> EndedPart:
    if robot is None and record.robots:
        names = ", ".join(record.robots)
        raise InputError(f"{directory}: several robots, choose with --robot: {names}")
    if robot is None:
        return record
    if robot not in record.robots:
        raise UnknownNameError("robot", robot, record.robots)
    return record.robots[robot]


@dataclass(frozen=True, slots=True, kw_only=True)
class CauseCount:
    """The number of a planner's runs that one cause decided.

    Attributes:
        runs: of the planner.
        example: the run whose decisive moment came first.
    """

    planner: str
    cause: Ending | Cause
    count: int
    runs: int
    example: Explanation

    @property
    def line(self) -> str:
        """Return planner, number and cause in words."""
        return f"{self.planner}: {self.count} of {self.runs} runs {self.cause.past}"


def common_causes(directories: Iterable[Path]) -> tuple[list[CauseCount], list[str]]:
    """Count the causes of many runs, most frequent first, planner by planner.

    Returns:
        The counts, and why some runs have no explanation.
    """
    found: dict[tuple[str, Ending | Cause], list[Explanation]] = {}
    left_out: list[str] = []
    for one in _each(directories, left_out):
        found.setdefault((one.record.planner.label, one.moment.cause), []).append(one)
    totals: dict[str, int] = {}
    for (planner, _), some in found.items():
        totals[planner] = totals.get(planner, 0) + len(some)
    counts = [
        CauseCount(
            planner=planner, cause=cause, count=len(some), runs=totals[planner],
            example=min(some, key=lambda e: (e.moment.t, str(e.directory))),
        )
        for (planner, cause), some in found.items()
    ]  # fmt: skip
    counts.sort(key=lambda c: (c.planner, -c.count, DECIDING.index(c.cause)))
    return counts, left_out


def _each(directories: Iterable[Path], left_out: list[str]) -> Iterator[Explanation]:
    for directory in directories:
        try:
            record = RunRecord.read(directory)
            for robot in record.robots or (None,):
                yield explain(directory, robot)
        except InputError as error:
            left_out.append(str(error))
