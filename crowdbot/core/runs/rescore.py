"""Score recorded runs again, one by one or in parallel; a bad run does not stop the others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from multiprocessing import get_context
from pathlib import Path

from crowdbot.core.recording.reading.commands import read_commands
from crowdbot.core.recording.recording import Recording, RobotRecording
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.identity import CROWD_ALONE, ROBOT_ALONE
from crowdbot.core.runs.provenance import trajectory_hash
from crowdbot.core.runs.read_and_score import (
    reference_hashes,
    references_by_robot,
    score_robots,
)
from crowdbot.core.runs.recordings import RecordingSource, find_source
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.questionnaires import Questionnaires
from crowdbot.core.trajectories.sizes import check_sizes
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from crowdbot.errors import CrowdbotError, InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class RescoreRequest:
    """The input of a rescoring.

    Attributes:
        path: run directory or recording; None for commands or answers only.
        robot: robot whose topics to read from a recording with several.
        topics: topics of the user's and the final command in the recording.
        commands, commands_baseline: CSV files, run directories, or recordings with the two topics.
        limits: largest speed (m/s) and yaw rate (rad/s) that can be commanded.
        questionnaires: CSV file.
        allow_incomplete: score the readable part of an incomplete recording.
        plugins, allow: plugin paths and allow-list for separate processes.
    """

    path: Path | None
    robot_alone: Path | None = None
    crowd_alone: Path | None = None
    robot: str | None = None
    topics: tuple[str, str] | None = None
    commands: Path | None = None
    commands_baseline: Path | None = None
    limits: tuple[float | None, float | None] = (None, None)
    questionnaires: Path | None = None
    metrics: tuple[str, ...] = ("*",)
    variants: str = "all"
    allow_incomplete: bool = False
    plugins: tuple[Path, ...] = ()
    allow: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Rescored:
    """Scores of one run, or the reason for their absence.

    Attributes:
        until: s, end of the readable part; None without a recording.
        complete: True if the recording is complete.
    """

    source: RecordingSource
    scores: tuple[Score, ...] = ()
    until: float | None = None
    complete: bool = True
    error: str = ""
    exit_code: int = 0


class IncompleteError(InputError):
    """A recording is incomplete; ``until`` is the end of its readable part, s."""

    def __init__(self, text: str, until: float) -> None:
        super().__init__(text)
        self.until = until


def rescore(request: RescoreRequest, registry: Registry) -> Rescored:
    """Score one run again from its recording.

    Raises:
        IncompleteError: a recording is incomplete, which is not allowed.
        CrowdbotError: it cannot be read, or a metric failed.
    """
    source, run = RecordingSource(path=Path(), recording=Path()), None
    recordings: list[RobotRecording] = []

    def check(recording: Recording, robot: str | None) -> Trajectories:
        recordings.append(_checked(recording, robot, allowed=request.allow_incomplete))
        return recordings[-1].run

    def read(file: Path | None, robot: str | None = None) -> Trajectories | None:
        if file is None:
            return None
        with Recording(file) as recording:
            # a calibration run may hold several robots or one
            return check(recording, robot if recording.robots else None)

    if request.path is not None:
        source = find_source(request.path, request.robot_alone, request.crowd_alone)
        with Recording(source.recording) as recording:
            # a recording with only commands need not be a run
            if request.topics is None or recording.holds_run:
                if request.robot is None and recording.robots:
                    return _whole_fleet(request, source, recording, registry)
                run = check(recording, request.robot)
    scores = score(
        registry,
        run,
        _of_run(source, ROBOT_ALONE, read(source.robot_alone, request.robot)),
        _of_run(source, CROWD_ALONE, read(source.crowd_alone)),
        commands=_commands(request, request.commands, source),
        commands_baseline=_commands(request, request.commands_baseline, None),
        questionnaires=_answers(request.questionnaires),
        metrics=request.metrics,
        variants=request.variants,
    )
    return Rescored(
        source=source,
        scores=tuple(scores),
        until=None if run is None else recordings[0].until,
        complete=all(one.complete for one in recordings),
    )


def _whole_fleet(
    request: RescoreRequest, source: RecordingSource, recording: Recording, registry: Registry
) -> Rescored:
    """Return all robots of a run, and the fleet.

    Raises:
        IncompleteError: the recording is incomplete, which is not allowed.
        CrowdbotError: it cannot be read, or a metric failed.
    """
    fleet = {name: recording.robot(name) for name in recording.robots}
    until = max(one.until for one in fleet.values())
    complete = all(one.complete for one in fleet.values())
    if not complete and not request.allow_incomplete:
        raise _cut(source.recording, until)
    named = {ROBOT_ALONE: source.robot_alone, CROWD_ALONE: source.crowd_alone}
    paths = {name: path for name, path in named.items() if path is not None}
    for name, sha in reference_hashes(paths).items():
        _check_reference(source, name, sha)
    scores = score_robots(
        registry,
        {name: one.run for name, one in fleet.items()},
        references_by_robot(paths, tuple(fleet)),
        metrics=request.metrics,
        variants=request.variants,
    )
    return Rescored(source=source, scores=tuple(scores), until=until, complete=complete)


def _of_run(source: RecordingSource, name: str, run: Trajectories | None) -> Trajectories | None:
    """Return a calibration run, if it is the one that the run was scored with.

    Raises:
        InputError: it is another one.
    """
    if run is not None and name in source.hashes:
        _check_reference(source, name, trajectory_hash(run))
    return run


def _check_reference(source: RecordingSource, name: str, sha: str) -> None:
    if source.hashes.get(name, sha) != sha:
        raise InputError(
            f"{source.path}: its {name} is another one than it was scored with: "
            f"{getattr(source, name)} was changed or replaced"
        )


def _cut(file: Path, until: float) -> IncompleteError:
    text = f"{file}: the recording is cut: it can be read until {until:g} s"
    return IncompleteError(f"{text}; --allow-incomplete scores what is there", until)


def _checked(recording: Recording, robot: str | None, *, allowed: bool) -> RobotRecording:
    found = recording.robot(robot)
    if not found.complete and not allowed:
        raise _cut(recording.path, found.until)
    try:
        check_sizes(found.run)
    except InputError as error:  # name the calibration run's run in the error
        raise InputError(f"{recording.path}: damaged: {error}") from None
    return found


def rescore_all(
    requests: Sequence[RescoreRequest], registry: Registry, jobs: int
) -> Iterator[Rescored]:
    """Score many runs in order; errors are part of the results.

    With several ``jobs`` each process discovers the plugins itself.
    """
    if jobs == 1 or len(requests) == 1:
        for request in requests:
            yield _guarded(request, registry)
        return
    # a fresh interpreter, since threads of numpy and of the progress bar do not survive a fork
    with ProcessPoolExecutor(min(jobs, len(requests)), get_context("spawn")) as pool:
        try:
            yield from pool.map(_guarded, requests, chunksize=1)
        finally:
            pool.shutdown(cancel_futures=True)


def _guarded(request: RescoreRequest, registry: Registry | None = None) -> Rescored:
    try:
        return rescore(request, registry or _own_registry(request.plugins, request.allow))
    except CrowdbotError as error:
        text = str(error)
        path = request.path or Path()
        if str(path) not in text:
            text = f"{path}: {text}"
        source = RecordingSource(path=path, recording=path)
        until = error.until if isinstance(error, IncompleteError) else None
        return Rescored(
            source=source,
            error=text,
            exit_code=error.exit_code,
            until=until,
            complete=until is None,
        )


@cache
def _own_registry(plugins: tuple[Path, ...], allow: tuple[str, ...] | None) -> Registry:
    return discover(extra=plugins, allow=allow)


def _commands(
    request: RescoreRequest, file: Path | None, source: RecordingSource | None
) -> Commands | None:
    """Return commands from a CSV file, a run directory, topics of a recording, or the run."""
    v_max, w_max = request.limits
    if file is not None and file.is_dir():
        file = find_source(file).recording
    if file is not None and file.suffix.lower() == ".csv":
        if v_max is None or w_max is None:
            raise InputError(f"{file}: the largest v and w that can be commanded are needed")
        return Commands.from_csv(file, v_max=v_max, w_max=w_max)
    recording = file or (source.recording if source is not None and request.path else None)
    if request.topics is None:
        return None if file is None else _recorded(file, request.robot)
    if recording is None:
        return None
    return read_commands(recording, *request.topics, v_max=v_max, w_max=w_max)


def _recorded(file: Path, robot: str | None) -> Commands:
    """Return the commands of a recording whose robot has a joystick."""
    with Recording(file) as recording:
        found = recording.trajectories(robot if recording.robots else None).commands
    if found is None:
        text = "neither a CSV file, nor a recording with a joystick; name its two topics"
        raise InputError(f"{file}: {text}")
    return found


def _answers(file: Path | None) -> Questionnaires | None:
    return None if file is None else Questionnaires.from_csv(file)
