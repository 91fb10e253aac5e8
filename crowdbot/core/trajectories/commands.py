"""Commands of one drive: the user's, and the final ones after shared control."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from crowdbot.core.support.arguments import number_of, path_of
from crowdbot.core.support.immutable import immutable
from crowdbot.core.trajectories.table_columns.frames import in_seconds
from crowdbot.core.trajectories.text_table import read_table
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

COLUMNS = ("t", "v_user", "w_user", "v_sc", "w_sc")


@dataclass(frozen=True, slots=True, kw_only=True)
class Commands:
    """Commands of one drive; each holds until the next one.

    Attributes:
        t: (N,) times, s, strictly increasing.
        v_user, w_user: (N,) input of the user, m/s forward and rad/s counter-clockwise.
        v_sc, w_sc: (N,) final command after shared control, likewise.
        v_max, w_max: largest speeds that can be commanded, m/s and rad/s.
        t_end: end of the last command, s.
    """

    t: Array
    v_user: Array
    w_user: Array
    v_sc: Array
    w_sc: Array
    v_max: float
    w_max: float
    t_end: float

    @classmethod
    def from_arrays(
        cls,
        *,
        t: ArrayLike,
        v_user: ArrayLike,
        w_user: ArrayLike,
        v_sc: ArrayLike,
        w_sc: ArrayLike,
        v_max: float,
        w_max: float,
        t_end: float | None = None,
    ) -> Commands:
        """Build from plain arrays; without ``t_end`` the last command has no duration.

        Raises:
            InputError: a shape is wrong, a number is not finite, time does not increase, or a limit
                is not positive.
        """
        rows = dict(zip(COLUMNS, (t, v_user, w_user, v_sc, w_sc), strict=True))
        columns = {name: _column(name, values) for name, values in rows.items()}
        times = columns["t"]
        for name, column in columns.items():
            if len(column) != len(times):
                raise InputError(f"commands: {name} has {len(column)} rows, t has {len(times)}")
        if not len(times) or np.any(np.diff(times) <= 0):
            raise InputError("commands: t must not be empty, and must strictly increase")
        for name, limit in (("v_max", v_max), ("w_max", w_max)):
            if not 0 < number_of(name, limit) < math.inf:
                raise InputError(f"commands: {name} must be positive")
        end = float(times[-1]) if t_end is None else number_of("t_end", t_end, "s")
        if not times[-1] <= end < math.inf:
            raise InputError(f"commands: t_end {end} s lies before the last command")
        return cls(**columns, v_max=float(v_max), w_max=float(w_max), t_end=end)

    @classmethod
    def from_csv(
        cls, path: Path | str, *, v_max: float, w_max: float, t_end: float | None = None
    ) -> Commands:
        """Read a table with the columns t, v_user, w_user, v_sc, w_sc, as `Trajectories` does.

        Others are ignored. Stamps are counted from the first.

        Raises:
            InputError: it cannot be read, a column is missing, or a cell is not a number.
        """
        table = read_table(path_of("path", path), {}, COLUMNS)
        table.require("", *COLUMNS)
        seconds = in_seconds({"commands": table}, None)["commands"]
        stamps = seconds.stamps()
        times, _ = seconds.times(origin=0 if stamps is None else int(stamps.min()))
        columns = {"t": times, **{name: table.numbers(name) for name in COLUMNS[1:]}}
        return cls.from_arrays(**columns, v_max=v_max, w_max=w_max, t_end=t_end)

    @property
    def durations(self) -> Array:
        """Return how long each command holds (N,), s."""
        return np.diff(self.t, append=self.t_end)


def _column(name: str, values: ArrayLike) -> Array:
    try:
        column = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"commands: {name}: {error}") from error
    if column.ndim != 1 or not np.all(np.isfinite(column)):
        raise InputError(f"commands: {name} must be a row of finite numbers")
    return immutable(column)
