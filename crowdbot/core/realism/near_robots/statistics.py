"""Distributions of the features of encounters, by kind of encounter and speed of the robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.realism.json_numbers import number_or_nan, rounded
from crowdbot.core.realism.near_robots.encounters import VEHICLE, RobotEncounter
from crowdbot.core.realism.near_robots.features import FEATURES, SHARES
from crowdbot.core.types.arrays import Array

#: Quantiles by which distributions are compared.
LEVELS = np.linspace(0.05, 0.95, 19)
#: Names and upper ends of the classes of robot speed, m/s.
SPEEDS = (("slow", 0.6), ("walking", VEHICLE), ("vehicle", np.inf))
KINDS = ("front", "cross", "behind")
#: Cells with fewer recorded encounters are not compared.
LEAST = 6
#: A feature needs this many known values.
_LEAST_VALUES = 3

Cell = tuple[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class CellStatistics:
    """Distributions of features in one cell.

    Attributes:
        count: number of encounters.
        quantiles: feature -> (19,) quantiles at `LEVELS`, NaN if unknown.
        shares: feature -> mean, for `SHARES`; NaN if unknown.
    """

    count: int
    quantiles: Mapping[str, Array]
    shares: Mapping[str, float]

    def as_json(self) -> dict[str, Any]:
        """Return data that `from_json` reads."""
        return {
            "count": self.count,
            "quantiles": {n: [rounded(v, 3) for v in q] for n, q in self.quantiles.items()},
            "shares": {n: rounded(v, 3) for n, v in self.shares.items()},
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> CellStatistics:
        """Read data from `as_json`."""
        return cls(
            count=int(data["count"]),
            quantiles={
                n: np.array([number_or_nan(v) for v in q]) for n, q in data["quantiles"].items()
            },
            shares={n: number_or_nan(v) for n, v in data["shares"].items()},
        )


def cell_of(e: RobotEncounter) -> Cell:
    """Return kind of encounter and class of the robot's speed."""
    return e.kind, next(name for name, top in SPEEDS if e.robot_speed < top)


def statistics_of(
    encounters: Sequence[RobotEncounter], features: Array
) -> dict[Cell, CellStatistics]:
    """Return the distributions of (E, F) features by cell, in a fixed order."""
    cells = [cell_of(e) for e in encounters]
    statistics = {}
    for kind in KINDS:
        for speed, _ in SPEEDS:
            here = np.array([c == (kind, speed) for c in cells], np.bool_)
            if here.any():
                statistics[kind, speed] = _cell(features[here])
    return statistics


def _cell(rows: Array) -> CellStatistics:
    quantiles, shares = {}, {}
    for k, name in enumerate(FEATURES):
        known = rows[np.isfinite(rows[:, k]), k]
        enough = len(known) >= _LEAST_VALUES
        if name in SHARES:
            shares[name] = float(known.mean()) if enough else np.nan
        else:
            quantiles[name] = np.quantile(known, LEVELS) if enough else np.full(len(LEVELS), np.nan)
    return CellStatistics(count=len(rows), quantiles=quantiles, shares=shares)
