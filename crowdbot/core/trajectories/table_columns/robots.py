"""Rows of robots in tables of people."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from crowdbot.core.trajectories.raw_table import RawTable

_ROBOT = re.compile(r"(?<![a-z])robot(?!ic)", re.IGNORECASE)  # robot_1, no robotics student


def is_robot(name: Any) -> bool:
    """Return True for a name or a kind of a robot, such as ``robot_1``."""
    return isinstance(name, str) and _ROBOT.search(name) is not None


def without_robots(table: RawTable) -> RawTable:
    """Return a table of people without the rows whose id or kind says that they are a robot's.

    A note counts them. Where no other row is left, the table is returned as it is.
    """
    ids = table.columns.get("id", ())
    robots = {i for cells in (ids, table.kinds) for i, cell in enumerate(cells) if is_robot(cell)}
    kept = [i for i in range(len(table)) if i not in robots]
    if not robots or not kept:
        return table
    note = (
        f"{table.where(min(robots))}: rows of a robot are left out of the people: {len(robots)}, "
        "from here"
    )
    return replace(
        table,
        columns={name: [cells[i] for i in kept] for name, cells in table.columns.items()},
        lines=[table.lines[i] for i in kept] if len(table.lines) else (),
        kinds=[table.kinds[i] for i in kept] if len(table.kinds) else (),
        notes=[*table.notes, note],
    )
