"""Reject numbers that are too large to compute with."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError

#: Largest allowed number; map coordinates in millimetres are smaller.
_MOST = 1e12
#: Largest allowed time, s; nanoseconds since 1970 are smaller.
_LATEST = 1e20


def check_sizes(run: Trajectories) -> None:
    """Refuse unrealistic numbers, whose squares would overflow in metrics.

    Raises:
        InputError: a number exceeds 1e12, or a time 1e20.
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
