"""Encode contacts for the replay page."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.core.geometry.footprint import body_side
from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.trajectories import Trajectories


def contacts_of(run: Trajectories) -> list[dict[str, Any]]:
    """Return contacts by time; people by their index instead of their id, -1: a wall."""
    table = run.contacts
    if table is None:
        return []
    place = {-1: -1}
    if run.agents is not None:
        place |= {id_: i for i, id_ in enumerate(run.agents.id.tolist())}
    return [
        {
            "t0": float(table.t0[i]),
            "t1": float(table.t1[i]),
            "person": place.get(int(table.agent[i]), -1),
            "impulse": number(table.impulse[i]),
            "bearing": number(table.bearing[i]),
            "reach": round(_reach(run, float(table.bearing[i])), 4),
            "side": body_side(float(table.bearing[i])),
        }
        for i in np.argsort(table.t0, kind="stable")
    ]


def number(value: float) -> float | None:
    """Return a number for JSON, which has no infinity."""
    return float(value) if np.isfinite(value) else None


def _reach(run: Trajectories, bearing: float) -> float:
    """Return the distance of a robot's surface from its base in a direction, m; 0 without one."""
    if run.robot is None or not np.isfinite(bearing):
        return 0.0
    body = footprint_of(run)
    if body is None:
        return run.robot.radius
    steps = np.linspace(0.0, body.reach, 257)
    covered = body.gap(steps * np.cos(bearing), steps * np.sin(bearing)) <= 0.0
    return float(steps[covered].max(initial=0.0))
