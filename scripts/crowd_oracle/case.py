"""One case of the original crowd engine: its setup and all its steps."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.spec.component_specs import CostFunctionSpec
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec
from scripts.crowd_oracle.policy import cost_spec, policy_spec

#: Arrays of a case's trajectories.
COLUMNS = ("t", "id", "x", "y", "vx", "vy")


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Setup and states of one case; SI units.

    Attributes:
        states: (K + 1, N, 4) x, y, vx, vy.
        present: (K + 1, N) True if an agent is in the world; otherwise its state is NaN.
        agents: the mass is that of the original, without unit.
        goal: (N, 2).
        walls: (S, 4) edges of the obstacles, counter-clockwise around each.
        periodic_boundary: (x0, x1, y0, y1) or None.
        policies: spec and cost functions of each policy; ``agents.policy`` is an index into them.
    """

    name: str
    dt: float
    states: Array
    present: NDArray[np.bool_]
    agents: Agents
    goal: Array
    walls: Array
    periodic_boundary: tuple[float, float, float, float] | None
    policies: list[tuple[VelocitySpaceSpec, list[CostFunctionSpec]]]


def load(folder: Path, name: str) -> Case:
    """Load case ``name`` from a folder with ``name.json`` and ``name.npz``.

    Raises:
        OSError: a file is missing.
        ValueError: a file does not have the reference data's format, or names an unknown model.
    """
    given = json.loads((folder / f"{name}.json").read_text())
    with np.load(folder / f"{name}.npz") as data:
        return case_of(name, given, [np.asarray(data[c]) for c in COLUMNS])


def case_of(name: str, given: dict[str, Any], columns: Sequence[NDArray[Any]]) -> Case:
    """Build a case from its setup and rows of `COLUMNS`, one per agent and time.

    Raises:
        ValueError: see `load`.
    """
    if int(given.get("stored_every", 1)) != 1:
        raise ValueError("steps were left out (stored_every is not 1): nothing to compare")
    rows = [np.asarray(c, np.float64) for c in columns]
    ids = np.unique(rows[1]).astype(np.int64)
    states, present = _states(rows, ids)
    return Case(
        name=name,
        dt=float(given["dt"]),
        states=states,
        present=present,
        agents=_agents(given, ids),
        goal=np.array([a.get("goal", a["pos"]) for a in given["agents"]], np.float64),
        walls=_edges(given.get("obstacles") or []),
        periodic_boundary=_periodic_boundary(given["world"]),
        policies=[
            (policy_spec(p["attrs"]), [cost_spec(c) for c in p["cost"]]) for p in given["policies"]
        ],
    )


def _states(columns: list[Array], ids: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
    """Convert rows in any order to a table over times and agents, and a mask of existing rows."""
    times = np.unique(columns[0])
    states = np.full((len(times), len(ids), 4), np.nan)
    at = np.searchsorted(times, columns[0]), np.searchsorted(ids, columns[1])
    states[at] = np.column_stack(columns[2:])
    present = np.zeros(states.shape[:2], np.bool_)
    present[at] = True
    return states, present


def _agents(given: dict[str, Any], ids: NDArray[np.int64]) -> Agents:
    listed = given["agents"]
    if len(listed) != len(ids):
        raise ValueError(f"{len(listed)} agents in the set-up, {len(ids)} in the trajectories")
    policies = [str(p["attrs"].get("id", k)) for k, p in enumerate(given["policies"])]

    def row(name: str, default: float) -> list[float]:
        return [float(a.get(name, default)) for a in listed]

    return Agents.of(
        x=[a["pos"][0] for a in listed],
        y=[a["pos"][1] for a in listed],
        id=ids,
        radius=row("rad", 0.24),
        preferred_speed=row("pref_speed", 1.4),
        max_speed=row("max_speed", 1.8),
        max_acceleration=row("max_acceleration", 5.0),
        mass=row("mass", 1.0),
        policy=[policies.index(str(a.get("policy", policies[0]))) for a in listed],
    )


def _edges(polygons: list[list[list[float]]]) -> Array:
    edges = [
        [*a, *b]
        for points in polygons
        for a, b in zip(points, points[1:] + points[:1], strict=True)
    ]
    return np.array(edges, np.float64).reshape(-1, 4)


def _periodic_boundary(world: dict[str, str]) -> tuple[float, float, float, float] | None:
    if not str(world.get("type", "Infinite")).lower().startswith("toric"):
        return None
    x, y = 0.5 * float(world["width"]), 0.5 * float(world["height"])
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError("width and height of a toric world must be finite")
    return (-x, x, -y, y)
