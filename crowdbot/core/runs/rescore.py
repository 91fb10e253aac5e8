"""Scores of recorded runs, one after the other or several at a time; a bad one stops no other."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from crowdbot.core.recording.commands import read_commands
from crowdbot.core.recording.reader import holds_run, read_trajectories
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.runs.recordings import RecordingSource, find_source
from crowdbot.core.scoring.evaluate import score
from crowdbot.core.trajectories.commands import Commands
from crowdbot.core.trajectories.questionnaires import Questionnaires
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.score import Score
from crowdbot.errors import CrowdbotError, InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class RescoreRequest:
    """What to score, and from what.

    Attributes:
        path: run directory or recording; None where there are only commands or answers.
        robot: whose topics to read where a recording holds several robots.
        topics: of the user's and of the final command, in the recording.
        commands, commands_baseline: CSV files, or recordings with the two topics.
        limits: largest speed (m/s) and yaw rate (rad/s) that can be commanded.
        questionnaires: CSV file.
        plugins, allow: what a process of its own has to load: paths, and the allow-list.
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
    plugins: tuple[Path, ...] = ()
    allow: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Rescored:
    """Scores of one run, or why there are none."""

    source: RecordingSource
    scores: tuple[Score, ...] = ()
    error: str = ""
    exit_code: int = 0


def rescore(request: RescoreRequest, registry: Registry) -> Rescored:
    """Score one run again from what was recorded.

    Raises:
        CrowdbotError: it cannot be read, or a metric failed.
    """
    source, run = RecordingSource(path=Path(), recording=Path()), None
    if request.path is not None:
        source = find_source(request.path, request.robot_alone, request.crowd_alone)
        # a recording of nothing but commands is not a run, and need not be one
        if request.topics is None or holds_run(source.recording):
            run = read_trajectories(source.recording, request.robot)
    scores = score(
        registry,
        run,
        _reference(source.robot_alone),
        _reference(source.crowd_alone),
        commands=_commands(request, request.commands, source),
        commands_baseline=_commands(request, request.commands_baseline, None),
        questionnaires=_answers(request.questionnaires),
        metrics=request.metrics,
        variants=request.variants,
    )
    return Rescored(source=source, scores=tuple(scores))


def rescore_all(
    requests: Sequence[RescoreRequest], registry: Registry, jobs: int
) -> Iterator[Rescored]:
    """The same for many runs, in their order; what fails is told in the result.

    With several ``jobs`` each process discovers the plugins for itself.
    """
    if jobs == 1 or len(requests) == 1:
        for request in requests:
            yield _guarded(request, registry)
        return
    # a fresh interpreter: threads of numpy and of the progress bar do not survive a fork
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
        return Rescored(source=source, error=text, exit_code=error.exit_code)


@cache
def _own_registry(plugins: tuple[Path, ...], allow: tuple[str, ...] | None) -> Registry:
    return discover(extra=plugins, allow=allow)


def _commands(
    request: RescoreRequest, file: Path | None, source: RecordingSource | None
) -> Commands | None:
    """From a CSV file, from the topics of a recording, or from those of the run itself."""
    v_max, w_max = request.limits
    if file is not None and file.suffix.lower() == ".csv":
        if v_max is None or w_max is None:
            raise InputError(f"{file}: the largest v and w that can be commanded are needed")
        return Commands.from_csv(file, v_max=v_max, w_max=w_max)
    recording = file or (source.recording if source is not None and request.path else None)
    if request.topics is None:
        if file is not None:
            raise InputError(f"{file}: no CSV file; for a recording name the two topics")
        return None
    if recording is None:
        return None
    return read_commands(recording, *request.topics, v_max=v_max, w_max=w_max)


def _reference(file: Path | None) -> Trajectories | None:
    return None if file is None else read_trajectories(file)


def _answers(file: Path | None) -> Questionnaires | None:
    return None if file is None else Questionnaires.from_csv(file)


def available_cores() -> int:
    """Cores that this process may use."""
    affinity: Any = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1
