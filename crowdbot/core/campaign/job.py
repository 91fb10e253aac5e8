"""Messages to and from workers: plain values that can be pickled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from crowdbot.core.runs.run_options import RunOptions

Kind = Literal["crowd_alone", "robot_alone", "run"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SuiteSource:
    """Location of a suite, for a worker to open: name or file, and overrides.

    Attributes:
        spec: absolute path, or the name of a packaged suite.
        overrides: ``key=value`` texts.
        plugins: absolute paths of plugins that are not installed.
        allowed: the allow-list of installed plugins; None allows all.
        crowds: names or absolute paths of crowds that replace the scenarios' own.
    """

    spec: str
    overrides: tuple[str, ...] = ()
    plugins: tuple[str, ...] = ()
    allowed: tuple[str, ...] | None = None
    crowds: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """One simulation: a run, or a calibration run that several runs share.

    Attributes:
        key: id of its result; equal keys mean equal jobs.
        index: index of the scenario in its suite; ``spec_hash`` must match.
        planner_digest: digest of all that defines the planner.
        planner, settings: arguments of `resolve_planner`, with absolute file names.
        label: the planner's folder.
        out: absolute root of the results.
        directory: folder of the result, relative to ``out``.
        options: run options; the metrics are those of the suite.
        depends_on: keys of the calibration runs that must have ended before.
        cost: expected processor time, s.
        altered: changes to the scenario, from ``--set``.
        added: True if only floors and ceilings that the user did not name need it.
    """

    key: str
    kind: Kind
    source: SuiteSource
    suite: str
    scenario: str
    index: int
    spec_hash: str
    planner_digest: str
    planner: str
    settings: tuple[str, ...]
    label: str
    seed: int
    out: str
    directory: str
    options: RunOptions
    depends_on: tuple[str, ...] = ()
    cost: float = 0.0
    altered: tuple[str, ...] = ()
    added: bool = False

    @property
    def title(self) -> str:
        """Return a readable name."""
        names = {"crowd_alone": "crowd alone", "robot_alone": f"{self.label} alone"}
        return f"{self.scenario} · {names.get(self.kind, self.label)} · seed {self.seed}"


@dataclass(frozen=True, slots=True, kw_only=True)
class JobOutcome:
    """The outcome of a job.

    Attributes:
        status: status of the run; empty without a run, and then ``error`` explains it.
        exit_code: the equivalent exit code of `crowdbot simulate`.
        traceback: the Python traceback, or the last stderr output of a dead process.
        disk_full: True if the error is a full disk: a fault of the machine, not of the run.
        wall_time: wall time of the whole job, s.
        stages: name -> wall time of its parts, s.
    """

    key: str
    status: str = ""
    error: str = ""
    exit_code: int = 0
    traceback: str = ""
    disk_full: bool = False
    wall_time: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
