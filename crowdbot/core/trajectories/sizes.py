"""Whether the numbers of a run can be computed with."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError

#: Largest number of a run; coordinates of maps in millimetres are smaller.
_MOST = 1e12
#: The same of times, s; nanoseconds since 1970 are smaller.
_LATEST = 1e20


def check_sizes(run: Trajectories) -> None:
    """Refuse numbers that nothing real has: their squares would overflow in metrics.

    Raises:
        InputError: one is beyond 1e12, or 1e20 of a time.
    """
    _check("t", run.t, _LATEST)
    parts = {"robot": run.robot, "agent": run.agents, "trip": run.trips, "contacts": run.contacts}
    for part, held in parts.items():
        for field in fields(held) if held is not None else ():
            _check(f"{part}_{field.name}", getattr(held, field.name), _MOST)


def _check(name: str, column: Any, most: float) -> None:
    values = np.asarray(column)
    if values.dtype.kind == "f" and np.any((np.abs(values) > most) & np.isfinite(values)):
        raise InputError(f"trajectories: {name} has a number beyond {most:g}")
