"""Bodies of people: all alike, or each drawn from the kinds that the crowd is a mixture of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from crowdbot.core.population.draws import RngOf, draw_normal, draw_one
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.people_kinds import USUAL_BODIES, LengthChoice, MassChoice, PeopleKind

#: From the floor to the hip, of the height; see `crowdbot.core.sensing.body_model`.
HIP = 0.53


@dataclass(frozen=True, slots=True)
class Bodies:
    """Bodies of some people.

    Attributes:
        radius, mass: (N,) m and kg.
        pace: (N,) preferred speed as a multiple of what the crowd draws.
        speed: (N,) preferred speed where a kind has its own, m/s; else 0.
        seen: columns of the table for what sensors see; none where all are alike.
    """

    radius: Array
    mass: Array
    pace: Array
    speed: Array
    seen: Mapping[str, Sequence[Any]] = field(default_factory=dict)

    def walk_at(self, speeds: Array) -> Array:
        """Preferred speeds (N,) of people who would draw ``speeds`` if they were adults, m/s."""
        own: Array = np.where(self.speed > 0.0, self.speed, speeds * self.pace)
        return own

    def row(self, i: int) -> dict[str, Any]:
        """What of the table one person has from here."""
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
    """Draw the bodies of some people, each from random numbers of its own.

    Args:
        kinds: those of the crowd, by name; without any all are as ``usual``.
        names: those that these people are made of; all if empty.
        usual: (N,) radii and masses of people without a kind, m and kg.
        rng: purpose and person to a generator.
        fixed: whether radius and mass are as ``usual`` whatever the kind is.
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
    """As given, else as usual: a number, or mean and standard deviation."""
    if given is not None:
        return draw_one(rng(purpose, i), given)
    return usual if isinstance(usual, float) else draw_normal(rng(purpose, i), *usual)


__all__ = ["HIP", "Bodies", "draw_bodies"]
