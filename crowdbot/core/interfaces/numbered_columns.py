"""Old names for columns of cost functions' arguments, kept until 1.0."""

from __future__ import annotations

import importlib
import warnings
from typing import Any

from crowdbot.old_names import OldNameWarning

NUMBERED_COLUMNS = {
    "AGENT_SIZE", "ASKED_RADIUS", "ASKED_X", "ASKED_Y", "AX", "AY", "BX", "BY", "D2", "DESCENDS",
    "FASTEST", "FROM_SURFACE", "GX", "GY", "MAX_ACCELERATION", "MAX_SPEED", "NEAR_COLUMNS", "NPX",
    "NPY", "NVX", "NVY", "NX", "NY", "PARITY", "PREFERRED", "PVX", "PVY", "PX", "PY", "RADIUS",
    "RANDOM", "RANGE", "REACH", "RELAXATION", "RX", "RY", "STATIC", "TIME_STEP", "VX", "VY",
    "WALL_COLUMNS", "WALL_D2", "WEIGHT", "near_table", "wall_table", "work_table",
}  # fmt: skip
_HOME = "crowdbot.core.crowd.velocity_search.numbered_columns"


def numbered_column(name: str) -> Any:
    """Return a column's number, or a function that makes a table, with a warning."""
    warnings.warn(
        f"{name} goes with 1.0: fields of agents, neighbours and walls have names "
        "(agent.px, near[j].nvx, walls[s].d2), and as_rows gives names to work; see "
        "docs/reference/plugins.md",
        OldNameWarning,
        stacklevel=3,
    )
    return getattr(importlib.import_module(_HOME), name)
