"""Fit the parameters of a crowd to recorded people with CMA-ES.

Source: Hansen, "The CMA evolution strategy: a tutorial", 2016, with the library cmaes. A fit keeps
a log of all points and losses: the strategy is deterministic, so an interrupted fit is replayed
from its log and continues.
"""

from __future__ import annotations

import hashlib
import json
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from cmaes import CMA

from crowdbot.core.realism.compare import beside, score
from crowdbot.core.realism.corridor import corridors, simulate
from crowdbot.core.realism.model import model_of
from crowdbot.core.realism.parameters import Parameter, overrides_of, shares_of
from crowdbot.core.realism.reference import RealismReference, read_reference, shipped
from crowdbot.core.realism.statistics import Statistics, statistics_of
from crowdbot.core.registry.registry import Registry, discover
from crowdbot.core.scenarios.named_crowds import open_crowd
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.text_files import LARGEST_TABLE, input_bytes, input_text
from crowdbot.core.trajectories.data_sets.homography import AS_STATED, VideoScale
from crowdbot.errors import CrowdbotError, InputError

#: Spread of the first generation, as a share of each parameter's range.
_SPREAD = 0.15
#: Loss of a crowd that cannot be simulated.
_WORST = 1.0
#: Errors below these limits cost nothing; cost of errors above.
_FREE_ERROR, _ERROR_WEIGHT = 0.03, 0.4
_FREE_OVERLAP, _OVERLAP_WEIGHT = 0.006, 2.0
#: Seeds that generations use in turn, and seeds for the final result.
_DRAWS, HELD_OUT_DRAWS = 7, (101, 102, 103)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fitted(ABC):
    """The inputs of a fit, in plain values that can be sent to workers; computes its losses.

    Attributes:
        crowd: name or path, as `open_crowd` takes it, or a kind of response.
        overrides: ``key=value`` texts that override the crowd's parameters.
        plugins, allowed: as `discover` takes them.
        files: the user's recordings; empty: those shipped with crowdbot.
    """

    crowd: str
    overrides: tuple[str, ...] = ()
    plugins: tuple[str, ...] = ()
    allowed: tuple[str, ...] | None = None
    files: tuple[str, ...] = ()

    @property
    @abstractmethod
    def ceiling(self) -> float:
        """Return the score of one half of the recordings against the other."""

    @property
    @abstractmethod
    def inputs(self) -> list[Any]:
        """Return the values that identify this fit in its log."""

    @abstractmethod
    def loss(self, overrides: Sequence[str], seed: int) -> float:
        """Return the loss with some parameters in one draw."""

    @abstractmethod
    def scores(self, overrides: Sequence[str]) -> tuple[float, float]:
        """Return the scores against both halves of the recordings."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FitTask(Fitted):
    """The definition of a fit of a crowd.

    Attributes:
        warm_up, duration: times for each corridor, s.
        scale: of tables among the recordings.
    """

    warm_up: float = 5.0
    duration: float = 7.0
    scale: VideoScale = AS_STATED

    @property
    def reference(self) -> RealismReference:
        """Return the recorded people: the first half for the fit, the second held out."""
        return _reference(self.files, self.scale)

    @property
    def ceiling(self) -> float:
        """Return the score of one half of the recordings against the other."""
        return self.reference.ceiling.score

    @property
    def inputs(self) -> list[Any]:
        """Return the values that identify this fit in its log."""
        files: list[Any] = [digest(Path(f)) for f in self.files]
        scale = [self.scale.homography, self.scale.frame_rate] if self.scale else []
        return [self.crowd, self.overrides, files + scale]

    def loss(self, overrides: Sequence[str], seed: int) -> float:
        """Return the loss of a crowd, see `loss`."""
        return loss(self, overrides, seed)

    def scores(self, overrides: Sequence[str]) -> tuple[float, float]:
        """Return the scores against both halves, with held-out draws."""
        own = _walk(self, overrides, HELD_OUT_DRAWS, 6.0, 10.0)
        first, second = self.reference.halves
        return score(own, first).score, score(own, second).score


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """Fitted parameters and their scores against recordings.

    Attributes:
        values, spread: key -> value and standard deviation, SI units.
        training, held_out: scores against both halves of the recordings.
        ceiling: score of one half of the recordings against the other.
        evaluations: number of simulated crowds.
    """

    values: dict[str, float]
    spread: dict[str, float]
    training: float
    held_out: float
    ceiling: float
    evaluations: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Generation:
    """One step of a fit for an observer: number, losses, and True if it came from the log."""

    number: int
    losses: Sequence[float]
    from_log: bool


def fit(
    task: Fitted,
    parameters: Sequence[Parameter],
    log: Path,
    *,
    generations: int,
    population: int = 0,
    seed: int = 1,
    jobs: int = 1,
    watch: Callable[[Generation], None] = lambda _generation: None,
) -> Fit:
    """Run a fit, continuing from the log if there is one.

    Args:
        log: file with one line per generation.
        population: crowds per generation; 0 means 4 + 3 ln(parameters).
        seed: seed of the strategy; equal seeds give equal fits for any ``jobs``.
        jobs: number of processes.

    Raises:
        InputError: the log belongs to another fit.
    """
    size = population or 4 + math.floor(3.0 * math.log(len(parameters)))
    strategy = CMA(
        mean=shares_of(parameters),
        sigma=_SPREAD,
        bounds=np.array([[0.0, 1.0]] * len(parameters)),
        seed=seed,
        population_size=max(4, size),
    )
    head = _head(task, parameters, seed, strategy.population_size)
    done = _read_log(log, head)
    logged = len(done)
    with _losses(task, jobs) as losses_of:
        for number in range(generations):
            points = [strategy.ask() for _ in range(strategy.population_size)]
            known = done[number] if number < len(done) else None
            if known is None:
                trials = [(overrides_of(parameters, p), 1 + number % _DRAWS) for p in points]
                known = losses_of(trials)
                _write_log(log, head, done := [*done[:number], list(known)])
            strategy.tell(list(zip(points, known, strict=True)))
            watch(Generation(number=number, losses=known, from_log=number < logged))
    return _result(task, parameters, strategy, generations)


def loss(task: FitTask, overrides: Sequence[str], seed: int) -> float:
    """Return 1 - score against the first half, plus costs of speed, lane and overlap errors."""
    try:
        own = _walk(task, overrides, (seed,), task.warm_up, task.duration)
    except CrowdbotError:
        return _WORST
    half = task.reference.halves[0]
    near = beside(own, half)
    errors = [e for e in (near.diagram_error, near.lane_error) if math.isfinite(e)]
    cost = sum(_ERROR_WEIGHT * max(0.0, e - _FREE_ERROR) for e in errors)
    if math.isfinite(near.overlap):
        cost += _OVERLAP_WEIGHT * max(0.0, near.overlap - _FREE_OVERLAP)
    return float(1.0 - score(own, half, seed).score + cost)


def _walk(
    task: FitTask, overrides: Sequence[str], seeds: Sequence[int], warm_up: float, duration: float
) -> Statistics:
    registry = registry_of(task.plugins, task.allowed)
    crowd = open_crowd(task.crowd, registry, [*task.overrides, *overrides])
    model = model_of(crowd, registry)
    return statistics_of(
        [
            simulate(model, c)
            for seed in seeds
            for c in corridors(seed, warm_up=warm_up, duration=duration)
        ]
    )


def _result(task: Fitted, parameters: Sequence[Parameter], strategy: CMA, generations: int) -> Fit:
    """Return the mean of the last generation, since a single best draw is luck."""
    mean = np.clip(np.asarray(strategy.mean, np.float64), 0.0, 1.0)
    deviation = strategy._sigma * np.sqrt(np.diag(strategy._C))
    training, held_out = task.scores(overrides_of(parameters, mean))
    return Fit(
        values={p.key: p.value(float(m)) for p, m in zip(parameters, mean, strict=True)},
        spread={
            p.key: 0.5 * abs(p.value(float(m + d)) - p.value(float(m - d)))
            for p, m, d in zip(parameters, mean, deviation, strict=True)
        },
        training=training,
        held_out=held_out,
        ceiling=task.ceiling,
        evaluations=generations * strategy.population_size,
    )


def _head(task: Fitted, parameters: Sequence[Parameter], seed: int, size: int) -> str:
    """Return the first line that a log of this fit must have."""
    inputs = [
        *task.inputs, seed, size,
        [(p.key, p.start, p.low, p.high) for p in parameters],
    ]  # fmt: skip
    return hashlib.sha256(json.dumps(inputs).encode()).hexdigest()


def digest(path: Path) -> str:
    """Return the SHA-256 of a file, hexadecimal."""
    return hashlib.sha256(input_bytes(path, 4 * LARGEST_TABLE)).hexdigest()


def _read_log(log: Path, head: str) -> list[list[float]]:
    """Return the losses of complete generations; a truncated line is dropped."""
    if not log.exists():
        return []
    lines: list[Any] = []
    for line in input_text(log).splitlines():
        try:
            lines.append(json.loads(line))
        except ValueError:
            break
    if not lines or not isinstance(lines[0], dict) or lines[0].get("fit") != head:
        raise InputError(f"{log}: the log of another calibration; remove it, or give another --out")
    return [[float(v) for v in line["losses"]] for line in lines[1:]]


def _write_log(log: Path, head: str, done: Sequence[Sequence[float]]) -> None:
    lines = [{"fit": head}, *({"losses": list(losses)} for losses in done)]
    atomic_write(log, "".join(json.dumps(line) + "\n" for line in lines))


_Trials = Sequence[tuple[Sequence[str], int]]


@contextmanager
def _losses(task: Fitted, jobs: int) -> Iterator[Callable[[_Trials], list[float]]]:
    """Yield a function for the losses of a generation: in this process or in several."""
    if jobs <= 1:
        yield lambda trials: [task.loss(overrides, seed) for overrides, seed in trials]
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:

        def all_of(trials: _Trials) -> list[float]:
            waiting = [pool.submit(task.loss, list(o), seed) for o, seed in trials]
            return [one.result() for one in waiting]

        yield all_of


@cache
def registry_of(plugins: tuple[str, ...], allowed: tuple[str, ...] | None) -> Registry:
    """Return the installed components, discovered once per process."""
    return discover(extra=[Path(p) for p in plugins], allow=allowed)


@cache
def _reference(files: tuple[str, ...], scale: VideoScale) -> RealismReference:
    return read_reference([Path(f) for f in files], scale) if files else shipped()
