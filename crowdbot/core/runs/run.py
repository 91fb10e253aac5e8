"""The request for a simulation, and the resulting run."""

from __future__ import annotations

import html
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crowdbot.core.planning.planner import Observation
from crowdbot.core.planning.resolve import PlannerChoice
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.watcher import Watcher
from crowdbot.core.registry.registry import Registry
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.outcome import Progress
from crowdbot.core.runs.run_options import USUAL, RunOptions
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.core.scoring.evaluate import Scores
from crowdbot.core.scoring.metric import References
from crowdbot.core.scoring.scores_csv import read_scores_csv
from crowdbot.core.support.arguments import path_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.ending import has_failed
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.suite.suite_entry import IN_NO_SUITE, SuiteEntry
from crowdbot.dsl.text.path_names import path_problem
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.crowd import CrowdEngine

#: Is given a function that returns what all robots see, by name.
OnBegin = Callable[[Callable[[], Mapping[str, Observation]]], None]
#: Is given the engine of the people, and what takes signals into the recording: time, name, value.
OnCrowd = Callable[["CrowdEngine", Callable[[float, str, float], None]], None]


@dataclass(frozen=True)
class Run:
    """A complete run on disk.

    Attributes:
        directory: where its files are.
        record: contents of ``run.json``; `RunRecord.document` is the same as plain values.
        reused: True if the run had been made before.
        replaced: how an earlier run in the same folder, which this one has replaced, was
            recorded differently; empty if there was none, or it was recorded in the same way.
    """

    directory: Path
    record: RunRecord = field(repr=False)
    reused: bool = False
    replaced: tuple[str, ...] = ()
    _keep: object = field(default=None, repr=False, compare=False)

    @classmethod
    def open(cls, directory: str | Path) -> Run:
        """Open an existing run.

        Args:
            directory: with its ``run.json``.

        Raises:
            InputError: the folder contains no complete run.
        """
        path = path_of("directory", directory)
        if not (path / files.RECORD).is_file():
            raise InputError(f"{directory}: no run directory, there is no {files.RECORD} in it")
        return cls(path, RunRecord.read(path), reused=True)

    @property
    def scenario(self) -> str:
        """Return the scenario's id."""
        return self.record.scenario

    @property
    def planner(self) -> str:
        """Return the planner's label, as in scores."""
        return self.record.planner.label

    @property
    def seed(self) -> int:
        """Return the run's seed."""
        return self.record.seed

    @property
    def status(self) -> str:
        """Return the ending of the run: ``arrived``, ``timeout``, or another word of the table."""
        return str(self.record.status)

    @property
    def failed(self) -> bool:
        """Return True if the run failed because of its planner."""
        return has_failed(self.status)

    @cached_property
    def scores(self) -> Scores:
        """Return the original scores, read from ``scores.csv``.

        Raises:
            InputError: they cannot be read, or were changed.
        """
        if wrong := files.changed(self.directory, self.record.document(), (files.SCORES,)):
            raise InputError(f"{self.directory}: {wrong}")
        rows = read_scores_csv(self.directory / files.SCORES)
        return Scores(tuple(r.score for r in rows), self.scenario, self.planner, self.seed)

    @cached_property
    def trajectories(self) -> Trajectories:
        """Return the run's trajectories, read from its recording.

        Raises:
            InputError: it has several robots; see `robots`.
        """
        with Recording(self.directory / files.RECORDING) as recording:
            return recording.trajectories()

    @cached_property
    def robots(self) -> Mapping[str, Trajectories]:
        """Return the run of each robot by name, if there are several; else empty."""
        if not self.record.robots:
            return {}
        with Recording(self.directory / files.RECORDING) as recording:
            return {name: recording.trajectories(name) for name in recording.robots}

    @cached_property
    def references(self) -> References:
        """Return the calibration runs, as far as they exist."""
        paths = self.record.references
        return read_references({n: (self.directory / p).resolve() for n, p in paths.items()})

    def _repr_html_(self) -> str:
        """Return the replay page for notebooks in a frame; without one, known facts."""
        facts = f"{self.scenario} · {self.planner} · seed {self.seed}: {self.status}"
        page = self.directory / files.REPLAY
        if not page.is_file():
            return f"<p>{html.escape(facts)}</p>"
        text = html.escape(page.read_text(encoding="utf-8"), quote=True)
        return (
            f'<iframe srcdoc="{text}" title="{html.escape(facts, quote=True)}" '
            'sandbox="allow-scripts" style="width:100%;height:640px;border:0"></iframe>'
        )


@dataclass(frozen=True, kw_only=True)
class Request:
    """The input of a simulation.

    Attributes:
        seed: seed of sensor noise and planner.
        out: root of the run directories.
        entry: the scenario's place in its suite.
        options: options of making the run.
        references_finished: the caller has made the references; those in which the planner failed
            are not tried again.
        progress: called several times a simulated second.
        stop: asked several times a simulated second; True ends the run as interrupted.
        on_hang: called when a planner cannot be interrupted; should end the process.
        watchers: show the run, not its references, while it goes on.
        on_begin: called when a recording of robots begins, with a function that returns what the
            planners of all robots that go on see at the present step; to be called within a step.
        on_crowd: called when a recording with people begins, not for references.
    """

    scenario: Scenario
    choice: PlannerChoice
    registry: Registry
    seed: int
    out: Path
    entry: SuiteEntry = IN_NO_SUITE
    options: RunOptions = USUAL
    references_finished: bool = False
    progress: Callable[[Progress], None] | None = None
    stop: Callable[[], bool] = lambda: False
    on_hang: Callable[[], object] | None = None
    watchers: Sequence[Watcher] = ()
    on_begin: OnBegin | None = None
    on_crowd: OnCrowd | None = None

    @property
    def pinned(self) -> bool:
        """Return True if planner and plugins all come from installed distributions."""
        return self.choice.pinned and all(p.pinned for p in self.registry.plugins if not p.error)

    @property
    def directory(self) -> Path:
        """Return the directory of the run.

        Raises:
            InputError: a name leads out of the root, or is reserved by crowdbot.
        """
        scenario = self.entry.folder(self.scenario.id)
        for name in (self.entry.suite, scenario, self.choice.label):
            if why := path_problem(name):
                raise InputError(f"no folder can be called '{name[:80]}': it {why}")
        return self.out / scenario / self.choice.label / f"seed-{self.seed}"


def read_references(paths: Mapping[str, Path]) -> References:
    """Return the recordings of the calibration runs, by name.

    Several runs share them, so the latest few are cached until their files change.
    """
    runs: dict[str, Any] = {name: read_kept(path) for name, path in paths.items()}
    return References(**runs)


def read_kept(path: Path) -> Trajectories:
    """Return the trajectories of a recording that several runs share.

    Raises:
        InputError: it cannot be read.
    """
    try:
        state = _state_of(path)
    except OSError:
        return _read(path)  # reports the error
    return _kept(*state)


def _state_of(path: Path) -> tuple[Path, int, int, int]:
    state = path.stat()
    return path.resolve(), state.st_ino, state.st_mtime_ns, state.st_size


@lru_cache(maxsize=4)  # one takes 18 MB with 200 people for 180 s
def _kept(path: Path, *state: int) -> Trajectories:
    del state  # a changed file is another recording
    return _read(path)


def _read(path: Path) -> Trajectories:
    with Recording(path) as recording:
        return recording.trajectories()
