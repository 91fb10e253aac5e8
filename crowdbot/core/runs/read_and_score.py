"""Read and score runs of one or several robots alike: robot -> run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.reading.images import ImageCollector
from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.recording import Recording
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import provenance
from crowdbot.core.runs.identity import CROWD_ALONE, ROBOT_ALONE
from crowdbot.core.runs.run import read_kept, read_references
from crowdbot.core.scoring.evaluate import Scores, score
from crowdbot.core.scoring.fleet_scores import fleet_scores
from crowdbot.core.scoring.metric import References
from crowdbot.core.support.json_digest import digest
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True)
class SeenRun:
    """One robot's run, its sensors, the readings of lidars, and its planner's drawings."""

    run: Trajectories
    scans: Sequence[ReplayScan]
    drawings: Mapping[str, Sequence[PlannerDrawing]] = field(default_factory=dict)
    sensors: Mapping[str, SensorInfo] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedRun:
    """The contents of a recording with one or several robots.

    Attributes:
        runs: run of each robot; with one robot, or people only, under an empty name.
        trajectory: hash of all simulated numbers.
        until: readable until, s.
    """

    header: RecordingHeader
    runs: Mapping[str, Trajectories]
    trajectory: str
    complete: bool
    until: float


def read_robots(
    path: Path,
    robots: Sequence[str],
    max_rate: float,
    images: ImageCollector | None = None,
) -> dict[str, SeenRun]:
    """Read the runs of all robots of a recording.

    Args:
        path: a recording.
        robots: the robots' names, in the scenario's order.
        max_rate: largest rate of scans, Hz.
        images: collector of camera images, in the same pass.

    Raises:
        InputError: it cannot be read, or a robot is not in it.
    """
    also = None if images is None else images.add
    with Recording(path, max_rate=max_rate, observe=also) as recording:
        if len(robots) == 1:
            return {
                robots[0]: SeenRun(
                    recording.trajectories(),
                    recording.scans(),
                    recording.drawings(),
                    recording.robot(None).header.sensors,
                )
            }
        if missing := [name for name in robots if name not in recording.robots]:
            raise InputError(f"{path}: robot '{missing[0]}' is not in it")
        return {
            name: SeenRun(
                recording.trajectories(name),
                recording.scans(robot=name),
                recording.drawings(name),
                recording.robot(name).header.sensors,
            )
            for name in robots
        }


def references_by_robot(paths: Mapping[str, Path], robots: Sequence[str]) -> dict[str, References]:
    """Return the references of each robot's run; see `read_references`."""
    if len(robots) == 1:
        return {robots[0]: read_references(paths)}
    people = read_references({n: p for n, p in paths.items() if n == CROWD_ALONE})
    if ROBOT_ALONE not in paths:
        return dict.fromkeys(robots, people)
    alone = read_robots(paths[ROBOT_ALONE], robots, 1.0)
    return {name: replace(people, robot_alone=alone[name].run) for name in robots}


def score_robots(
    registry: Registry,
    runs: Mapping[str, Trajectories],
    references: Mapping[str, References],
    metrics: str | Sequence[str] = "*",
    variants: str | Sequence[str] = "all",
) -> Scores:
    """Return the scores of a run: of its robot, or of the fleet and each robot.

    Raises:
        InputError: as `score`.
    """
    by_robot = {
        name: score(
            registry, run, references[name].robot_alone, references[name].crowd_alone,
            metrics=metrics, variants=variants,
        )
        for name, run in runs.items()
    }  # fmt: skip
    first = next(iter(by_robot.values()))
    return first if len(by_robot) == 1 else Scores(tuple(fleet_scores(by_robot)))


def trajectory_of(runs: Mapping[str, Trajectories]) -> str:
    """Return the hash of every simulated number of a run with one or several robots."""
    hashes = {name: provenance.trajectory_hash(run) for name, run in runs.items()}
    return next(iter(hashes.values())) if len(hashes) == 1 else digest(hashes)


def read_recorded(path: Path) -> RecordedRun:
    """Read a recording with one robot, several robots, or only people.

    Raises:
        InputError: it cannot be read.
    """
    with Recording(path) as recording:
        return recorded_run(recording)


def recorded_run(recording: Recording) -> RecordedRun:
    """Return the contents of an open recording; errors as `read_recorded`."""
    names = recording.robots
    found = {name: recording.robot(name or None) for name in names or ("",)}
    runs = {name: one.run for name, one in found.items()}
    return RecordedRun(
        header=next(iter(found.values())).header,
        runs=runs,
        trajectory=trajectory_of(runs),
        complete=all(one.complete for one in found.values()),
        until=max(one.until for one in found.values()),
    )


def reference_hashes(paths: Mapping[str, Path]) -> dict[str, str]:
    """Return the trajectory hashes of calibration runs by name, cached until the files change."""
    hashes = {}
    for name, path in paths.items():
        state = path.stat()
        hashes[name] = _hash(path.resolve(), state.st_ino, state.st_mtime_ns, state.st_size)
    return hashes


@lru_cache(maxsize=64)
def _hash(path: Path, *state: int) -> str:
    del state  # a changed file is another recording
    with Recording(path) as recording:
        if recording.robots:
            return recorded_run(recording).trajectory
    return provenance.trajectory_hash(read_kept(path))
