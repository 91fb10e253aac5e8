"""What is sent to a worker and what comes back: plain values that can be pickled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from crowdbot.core.runs.run_options import RunOptions

Kind = Literal["crowd_alone", "robot_alone", "run"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SuiteSource:
    """Where a worker finds a suite, to open it itself.

    Attributes:
        spec: absolute path, or the name of a packaged suite.
        overrides: ``key=value`` texts.
        plugins: absolute paths of plugins that are not installed.
        allowed: the allow-list of installed plugins; None allows all.
        crowds: names or absolute paths of crowds that take the place of the scenarios' own.
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
        key: id of what it makes; equal keys mean equal jobs.
        index: of the scenario in its suite; ``spec_hash`` says which one it has to be.
        planner, settings: as `resolve_planner` takes them, file names absolute.
        label: the planner's folder.
        out: absolute root of the results.
        directory: what is made, relative to ``out``.
        options: how; the metrics are those of the suite.
        depends_on: keys of the calibration runs that must have ended before.
        cost: expected processor time, s.
    """

    key: str
    kind: Kind
    source: SuiteSource
    suite: str
    scenario: str
    index: int
    spec_hash: str
    planner: str
    settings: tuple[str, ...]
    label: str
    seed: int
    out: str
    directory: str
    options: RunOptions
    depends_on: tuple[str, ...] = ()
    cost: float = 0.0

    @property
    def title(self) -> str:
        """What people call it."""
        who = {"crowd_alone": "crowd alone", "robot_alone": f"{self.label} alone"}
        return f"{self.scenario} · {who.get(self.kind, self.label)} · seed {self.seed}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Done:
    """How a job ended.

    Attributes:
        status: of the run; empty when there is none, and then ``error`` says why.
        exit_code: what `crowdbot simulate` would have ended with.
        traceback: what Python said, or what a process left on stderr before it died.
        wall_time: of the whole job, s.
        stages: name -> wall time of its parts, s.
    """

    key: str
    status: str = ""
    error: str = ""
    exit_code: int = 0
    traceback: str = ""
    wall_time: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
