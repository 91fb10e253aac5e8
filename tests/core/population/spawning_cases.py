"""A hall with spawns in it, for the tests of what is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.dsl.scenario.scenario import Scenario

REGISTRY = discover(allow=())
HALL: dict[str, Any] = {
    "kind": "corridor",
    "zones": {"hall": {"x": [0, 40], "y": [-20, 20]}, "box": {"x": [2, 8], "y": [-3, 3]}},
    "portals": {"a": {"x": [-1, 0], "y": [-5, 5]}, "b": {"x": [40, 41], "y": [-5, 5]}},
}
CROWD: dict[str, Any] = {
    "speed": {"mean": 1.3, "std": 0.2},
    "policy": {"kind": "velocity_space"},
    "costs": {"reflex": {"kind": "rvo"}},
}
LINKS: dict[str, list[str]] = {"n": ["e", "w"], "e": ["s", "n"], "s": ["w"], "w": ["n", "s"]}
AREAS: dict[str, Any] = {
    name: {
        "area": {"centre": [20 + 15 * x, 15 * y], "size": [2, 1], "rotation": 0.3},
        "next": links,
    }
    for (name, links), (x, y) in zip(LINKS.items(), [(0, 1), (1, 0), (0, -1), (-1, 0)], strict=True)
}
STANDING: dict[str, Any] = {"area": "box", "count": 8, "standing": True}


def hall(crowd: dict[str, Any], *robots: tuple[float, float]) -> Scenario:
    """A scenario as if it had been validated with its document."""
    return REGISTRY.scenario_model.model_validate(
        {
            "id": "x",
            "environment": HALL,
            "crowd": CROWD | crowd,
            "robots": {
                f"r{i}": {
                    "model": {"kind": "turtlebot2"},
                    "task": {"start": [x, y, 0], "goal": {"zone": "hall"}},
                }
                for i, (x, y) in enumerate(robots)
            },
        }
    )


def drawn(seed: int = 0, /, **spawns: dict[str, Any]) -> Realisation:
    return realise(hall({"spawns": spawns, "goal_areas": AREAS, "seed": {"root": seed}}))


def columns(table: Realisation, wanted: slice = slice(None)) -> dict[str, Any]:
    """Everything that was drawn; not the numbers, which only count."""
    names = set(Realisation.__slots__) - {"id", "group", "goal_key"}
    return {name: list(getattr(table, name)[wanted]) for name in sorted(names)}


def gaps(table: Realisation) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Distances between centres, the diagonal far."""
    distance = np.hypot(table.x[:, None] - table.x, table.y[:, None] - table.y)
    return distance + 1e9 * np.eye(len(table))


def groups(table: Realisation) -> Iterator[list[int]]:
    for number in sorted(set(table.group[table.group >= 0].tolist())):
        yield np.flatnonzero(table.group == number).tolist()
