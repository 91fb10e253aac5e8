"""Parts of a robot's body: appearance, mass and balance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

Vector = tuple[float, float, float]
Colour = tuple[float, float, float]

BLACK, COAL, GREY = (0.05, 0.05, 0.06), (0.13, 0.13, 0.14), (0.32, 0.33, 0.35)
SILVER, WOOD = (0.78, 0.79, 0.8), (0.2, 0.15, 0.11)
GLASS, GREEN = (0.35, 0.45, 0.6), (0.1, 0.8, 0.2)
WHITE, BLUE, ORANGE = (0.92, 0.92, 0.93), (0.16, 0.33, 0.62), (0.9, 0.48, 0.12)
SKIN = (0.8, 0.62, 0.5)


class Part(NamedTuple):
    """A cylinder (radius, 0, length along z) or a box (sides along x, y, z), from base_link.

    Attributes:
        mass: kg; 0 if only visible.
    """

    name: str
    shape: str
    size: Vector
    at: Vector
    colour: Colour
    mass: float = 0.0
    pitch: float = 0.0


def scaled(parts: Sequence[Part], mass: float) -> list[Part]:
    """Return parts with masses scaled to a total of ``mass`` (kg)."""
    scale = mass / sum(p.mass for p in parts)
    return [p._replace(mass=scale * p.mass) for p in parts]


def balance(body: list[Part]) -> tuple[Vector, Vector]:
    """Return the centre of mass (m, from base_link) and the moments of inertia about it (kg m^2).

    Products of inertia, a hundredth of the moments, are left out.
    """
    mass = sum(p.mass for p in body)
    cx, cy, cz = (sum(p.mass * p.at[i] for p in body) / mass for i in range(3))
    xx = yy = zz = 0.0
    for p in body:
        own = _moments(p)
        x, y, z = p.at[0] - cx, p.at[1] - cy, p.at[2] - cz
        xx += own[0] + p.mass * (y * y + z * z)
        yy += own[1] + p.mass * (x * x + z * z)
        zz += own[2] + p.mass * (x * x + y * y)
    return (cx, cy, cz), (xx, yy, zz)


def _moments(part: Part) -> Vector:
    a, b, c = part.size
    if part.shape == "box":
        m = part.mass / 12.0
        return m * (b * b + c * c), m * (a * a + c * c), m * (a * a + b * b)
    across = part.mass * (3.0 * a * a + c * c) / 12.0
    return across, across, 0.5 * part.mass * a * a
