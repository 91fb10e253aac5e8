"""Pack the named signals recorded by planners and plugins."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.core.replay.pack import pack_words
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array

_STEP_TIME = "planner step time"


def encode_signals(run: Trajectories) -> tuple[dict[str, Any], dict[str, str]]:
    """Return names, and times and values of each (2, P) as float32.

    One of them is the planner's time per step, s; steps are evenly spaced.
    """
    series = {name: rows for name, rows in run.signals.items() if len(rows)}
    steps = run.planner_step_time
    if steps is not None and len(steps):
        spread = np.linspace(run.t[0], run.t[-1], len(steps), endpoint=False)
        series = {**series, _STEP_TIME: np.column_stack((spread, steps))}
    about = [{"name": name, "count": len(rows)} for name, rows in series.items()]
    blobs = {f"signal{i}": pack_words(_rows(rows)) for i, rows in enumerate(series.values())}
    return {"signals": about}, blobs


def _rows(rows: Array) -> Array:
    return np.ascontiguousarray(rows.T).astype("<f4")
