"""Parameters that are varied, and their trials: on a grid, at random, or by Optuna."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.errors import MissingLibraryError, UsageError

How = Literal["grid", "random", "optuna"]
#: Parameter -> its value as text.
Trial = Mapping[str, str]
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\.\.({_NUMBER})((?::(?:log|int))*)")
#: Largest grid.
_MOST = 10_000


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterAxis:
    """A planner's parameter that a sweep varies: its values or its range.

    Attributes:
        name: key of the planner's parameter.
        values: its values, if they are listed.
        low, high: otherwise its range; ``log``: on a logarithmic scale; ``whole``: integers.
    """

    name: str
    values: tuple[str, ...] = ()
    low: float = 0.0
    high: float = 0.0
    log: bool = False
    whole: bool = False

    @staticmethod
    def parse(text: str) -> ParameterAxis:
        """Return the axis of ``KEY=A,B,C`` or ``KEY=LOW..HIGH[:log][:int]``.

        Raises:
            UsageError: it is neither.
        """
        name, _, rest = text.partition("=")
        wrong = f"--vary {text}: write KEY=A,B,C or KEY=LOW..HIGH, with :log or :int behind it"
        if not name.strip() or not rest.strip():
            raise UsageError(wrong)
        found = _RANGE.fullmatch(rest.strip())
        if found is None:
            values = tuple(dict.fromkeys(v.strip() for v in rest.split(",")))
            if not all(values) or ".." in rest:
                raise UsageError(wrong)
            return ParameterAxis(name=name.strip(), values=values)
        low, high, marks = float(found[1]), float(found[2]), found[3]
        if not low < high or (":log" in marks and low <= 0.0):
            above = ", and LOW above 0 for :log" if ":log" in marks else ""
            raise UsageError(f"--vary {text}: LOW must be below HIGH{above}")
        return ParameterAxis(
            name=name.strip(), low=low, high=high, log=":log" in marks, whole=":int" in marks
        )

    def at(self, share: float) -> str:
        """Return the value at a share of the axis, 0 to 1."""
        if self.values:
            return self.values[min(int(share * len(self.values)), len(self.values) - 1)]
        if self.log:
            value = math.exp(math.log(self.low) + share * math.log(self.high / self.low))
        else:
            value = self.low + share * (self.high - self.low)
        return str(round(value)) if self.whole else f"{value:.6g}"

    def steps(self, count: int) -> tuple[str, ...]:
        """Return the listed values, or ``count`` values from end to end."""
        if self.values:
            return self.values
        return tuple(dict.fromkeys(self.at(i / max(1, count - 1)) for i in range(count)))

    def is_end(self, value: str) -> bool:
        """Return True if a value is one of the ends of a range."""
        return not self.values and value in (self.at(0.0), self.at(1.0))


def parse_axes(texts: Sequence[str]) -> tuple[ParameterAxis, ...]:
    """Return all axes.

    Raises:
        UsageError: there is none, one is malformed, or a parameter is given twice.
    """
    axes = tuple(map(ParameterAxis.parse, texts))
    names = [axis.name for axis in axes]
    twice = next((n for n in names if names.count(n) > 1), "")
    if twice or not axes:
        raise UsageError(f"--vary {twice}: given twice" if twice else "which? Give --vary KEY=…")
    return axes


def trial_count(axes: Sequence[ParameterAxis], how: How, count: int, steps: int) -> int:
    """Return the number of trials; random ones may be fewer, since duplicates are skipped."""
    return math.prod(len(axis.steps(steps)) for axis in axes) if how == "grid" else count


def run_trials(
    axes: Sequence[ParameterAxis], how: How, count: int, seed: int, steps: int,
    score: Callable[[Trial], float | None], better: str,
) -> Iterator[Trial]:  # fmt: skip
    """Yield the trials in order, each before its score is asked for.

    The same arguments and scores give the same trials, so that a sweep can be resumed.

    Args:
        axes: the varied parameters.
        how: the way in which trials are chosen.
        count: number of random trials, or of trials by Optuna.
        seed: random seed.
        steps: values of a range in a grid.
        score: runs a trial and returns its score; None if it has none.
        better: ``higher`` or ``lower``.

    Raises:
        UsageError: the grid is too large.
        MissingLibraryError: Optuna is not installed.
    """
    if how == "optuna":
        yield from _by_optuna(axes, count, seed, score, better)
        return
    trials = _grid(axes, steps) if how == "grid" else _by_chance(axes, count, seed)
    for trial in trials:
        yield trial
        score(trial)


def _grid(axes: Sequence[ParameterAxis], steps: int) -> list[Trial]:
    values = [axis.steps(steps) for axis in axes]
    size = math.prod(map(len, values))
    if size > _MOST:
        raise UsageError(f"the grid has {size} trials, more than {_MOST}; use --how random")
    names = [axis.name for axis in axes]
    return [dict(zip(names, row, strict=True)) for row in itertools.product(*values)]


def _by_chance(axes: Sequence[ParameterAxis], count: int, seed: int) -> list[Trial]:
    rng = np.random.Generator(np.random.PCG64(stream_seed(seed, "sweep", "sweep.random")))
    shares = rng.random((count, len(axes)))
    return [{a.name: a.at(float(x)) for a, x in zip(axes, row, strict=True)} for row in shares]


def _by_optuna(
    axes: Sequence[ParameterAxis], count: int, seed: int,
    score: Callable[[Trial], float | None], better: str,
) -> Iterator[Trial]:  # fmt: skip
    try:
        import optuna
    except ImportError as error:
        raise MissingLibraryError(
            "--how optuna needs Optuna; install it with pip install 'crowdbot[sweep]'"
        ) from error
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    sampler = optuna.samplers.TPESampler(seed=stream_seed(seed, "sweep", "sweep.optuna") % 2**32)
    direction = "maximize" if better == "higher" else "minimize"
    study = optuna.create_study(direction=direction, sampler=sampler)
    for _ in range(count):
        drawn = study.ask()
        trial = {
            a.name: str(drawn.suggest_categorical(a.name, a.values))
            if a.values
            else a.at(drawn.suggest_float(a.name, 0.0, 1.0))
            for a in axes
        }
        yield trial
        value = score(trial)
        state = optuna.trial.TrialState.FAIL if value is None else None
        study.tell(drawn, value, state=state)
