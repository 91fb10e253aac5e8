"""Lines of ``crowdbot results power``: each pair of planners, then its conditions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any

from crowdbot.core.results.results import Results
from crowdbot.core.statistics.power import ConditionPower, Power, power
from crowdbot.core.statistics.table import Name, Table
from crowdbot.errors import InputError, UnknownNameError, UsageError

ALL = "all conditions"


def lines_of(
    results: Results, name: Name, sizes: Sequence[float], tests: int, axis: str = ""
) -> list[dict[str, Any]]:
    """Return a line for each pair of planners, then for its conditions, or labels of an axis.

    Raises:
        UsageError: a size is not above 0, or the score is a rate.
        UnknownNameError: no run has this score, or this axis.
        InputError: there is no pair of planners with common runs.
    """
    if not all(math.isfinite(size) and size > 0.0 for size in sizes):
        raise UsageError("--size must be above 0")
    table = Table(results)
    if name not in table.names:
        known = {".".join(n) for n in table.names}
        raise UnknownNameError("score", ".".join(name), known)
    if table.exposure_name(name) is not None:
        raise UsageError(
            f"{'.'.join(name)} is a rate over all runs; name a score that each run has"
        )
    axes = dict.fromkeys(axis for run in results.runs for axis in run.axes)
    if axis and axis not in axes:
        raise UnknownNameError("axis", axis, axes)
    pairs = combinations(table.planners, 2)
    level = 1.0 - 0.05 / tests
    found = [power(table, name, a, b, sizes=sizes, level=level, axis=axis) for a, b in pairs]
    lines = [line for one in found if one is not None for line in _lines(one, 1.0 - level)]
    if not lines:
        raise InputError("no two planners were run in the same scenario and seed")
    return lines


def _lines(found: Power, chance: float) -> Iterator[dict[str, Any]]:
    for part in (found.whole, *found.conditions):
        yield {"planners": f"{found.a} - {found.b}", **_line(part, chance)}


def _line(part: ConditionPower, chance: float) -> dict[str, Any]:
    line: dict[str, Any] = {
        "condition": part.condition or ALL,
        "pairs": part.pairs,
        "draws": part.draws,
        "difference": part.difference.value,
        "low": part.difference.low,
        "high": part.difference.high,
        "p": part.p,
        "apart": part.p <= chance,
        "deviation": part.deviation,
        "variance_share": part.share,
        "minutes": part.minutes,
        "information": None if part.information == math.inf else part.information,
    }
    return line | {f"runs_for_{size:g}": runs for size, runs in part.runs.items()}
