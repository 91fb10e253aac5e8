"""Bodies of people: all equal, or sampled from the crowd's mixture of kinds."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from crowdbot.core.population.draws import RngOf, draw_normal, draw_one
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.people_kinds import USUAL_BODIES, LengthChoice, MassChoice, PeopleKind

#: Height of the hip, as a share of the height; see `crowdbot.core.sensing.body_model`.
HIP = 0.53


@dataclass(frozen=True, slots=True)
class Bodies:
    """Sizes, masses and speeds of some people.

    Attributes:
        radius, mass: (N,) m and kg.
        pace: (N,) preferred speed as a multiple of the crowd's sample.
        speed: (N,) preferred speed of kinds with their own, m/s; else 0.
        seen: table columns of the appearance for sensors; empty if all are equal.
    """

    radius: Array
    mass: Array
    pace: Array
    speed: Array
    seen: Mapping[str, Sequence[Any]] = field(default_factory=dict)

    def walk_at(self, speeds: Array) -> Array:
        """Return preferred speeds (N,) of people, from the ``speeds`` sampled for adults, m/s."""
        own: Array = np.where(self.speed > 0.0, self.speed, speeds * self.pace)
        return own

    def row(self, i: int) -> dict[str, Any]:
        """Return one person's entries for the table."""
        seen = {name: column[i] for name, column in self.seen.items()}
        return {"radius": float(self.radius[i]), "mass": float(self.mass[i]), **seen}


def draw_bodies(
    kinds: Mapping[str, PeopleKind],
    names: Sequence[str],
    usual: tuple[Array, Array],
    rng: RngOf,
    *,
    fixed: tuple[bool, bool] = (False, False),
) -> Bodies:
    """Sample the bodies of some people, each with its own random numbers.

    Args:
        kinds: the crowd's kinds, by name; if empty, all are as ``usual``.
        names: kinds of these people; all if empty.
        usual: (N,) radii and masses of people without a kind, m and kg.
        rng: function from purpose and person to a generator.
        fixed: True to use the ``usual`` radius and mass for every kind.
    """
    radius, mass = usual[0].copy(), usual[1].copy()
    count = len(radius)
    pace, speed = np.ones(count), np.zeros(count)
    chosen = [kinds[name] for name in sorted(names or kinds)]
    if not chosen:
        return Bodies(radius, mass, pace, speed)
    edges = np.cumsum([kind.share for kind in chosen])
    seen: dict[str, list[Any]] = {n: [] for n in ("height", "leg_length", "phase", "look")}
    for i in range(count):
        place = rng("kind", i).random() * edges[-1]
        kind = chosen[int(np.searchsorted(edges, place, side="right"))]
        look = USUAL_BODIES[kind.look]
        if not fixed[0]:
            radius[i] = _one(rng, "radius", i, kind.radius, look.radius or float(radius[i]))
        if not fixed[1]:
            mass[i] = _one(rng, "mass", i, kind.mass, look.mass or float(mass[i]))
        pace[i] = look.pace
        if kind.speed is not None:
            speed[i] = draw_one(rng("speed", i), kind.speed)
        height = _one(rng, "height", i, kind.height, look.height)
        seen["height"].append(height)
        seen["leg_length"].append(
            min(_one(rng, "leg_length", i, kind.leg_length, HIP * height), 0.9 * height)
        )
        seen["phase"].append(2.0 * math.pi * rng("phase", i).random())
        seen["look"].append(kind.look)
    return Bodies(radius, mass, pace, speed, seen)


def _one(
    rng: RngOf,
    purpose: str,
    i: int,
    given: LengthChoice | MassChoice | None,
    usual: float | tuple[float, float],
) -> float:
    """Return the given number, else the default: a number, or mean and standard deviation."""
    if given is not None:
        return draw_one(rng(purpose, i), given)
    return usual if isinstance(usual, float) else draw_normal(rng(purpose, i), *usual)
