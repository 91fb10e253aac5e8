"""The parts of a TurtleBot2's body: what they look like and what they weigh.

Sizes and places after the makers' descriptions of Kobuki and TurtleBot2. Masses: the data sheets'
2.35 kg of the Kobuki (wheels included), 0.52 kg for each plate, 0.38 kg for all poles, 0.564 kg
of the Kinect, and 1.446 kg for a small computer, which makes 6.3 kg with two wheels of 0.15 kg. The
computer lies on the lowest plate where it keeps the balance over the axle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

Vector = tuple[float, float, float]
Colour = tuple[float, float, float]

BLACK, COAL, GREY = (0.05, 0.05, 0.06), (0.13, 0.13, 0.14), (0.32, 0.33, 0.35)
SILVER, WOOD = (0.78, 0.79, 0.8), (0.2, 0.15, 0.11)
GLASS, GREEN = (0.35, 0.45, 0.6), (0.1, 0.8, 0.2)

PLATES = (0.1204, 0.1772, 0.3864)  # heights of the plates' centres above base_link
_PLATE = 0.006  # thickness, m
_PLATE_X = -0.0136
_POLES = ((0.06, 0.135), (-0.105, 0.098))  # left ones; m
_CAMERA = (-0.087, 0.0, 0.287)
_COMPUTER_X = 0.0674


class Part(NamedTuple):
    """A cylinder (radius, 0, length along z) or a box (sides along x, y, z), from base_link.

    Attributes:
        mass: kg; 0 for what only is seen.
    """

    name: str
    shape: str
    size: Vector
    at: Vector
    colour: Colour
    mass: float = 0.0
    pitch: float = 0.0


def _base() -> list[Part]:
    return [
        Part("skirt", "cylinder", (0.1755, 0, 0.05), (0, 0, 0.031), BLACK, 0.9),
        Part("body", "cylinder", (0.17, 0, 0.036), (0, 0, 0.074), GREY, 0.75),
        Part("deck", "cylinder", (0.16, 0, 0.008), (0, 0, 0.096), COAL, 0.4),
        Part("led", "box", (0.012, 0.03, 0.006), (0.162, 0, 0.09), GREEN),
    ]


def _stack() -> list[Part]:
    plates = [
        Part(f"plate{i}", "cylinder", (0.17, 0, _PLATE), (_PLATE_X, 0, z), WOOD, 0.52)
        for i, z in enumerate(PLATES)
    ]
    bottoms, tops = (0.1, *PLATES[:-1]), PLATES
    gaps = [top - bottom - _PLATE for bottom, top in zip(bottoms, tops, strict=True)]
    # The weight of poles goes by their length.
    per_metre = 0.38 / (4.0 * sum(gaps))
    poles = [
        Part(
            f"pole{level}{side}{k}", "cylinder", (0.0075, 0, gap),
            (x, y if side == "l" else -y, 0.5 * (bottoms[level] + tops[level])),
            SILVER, per_metre * gap,
        )
        for level, gap in enumerate(gaps)
        for k, (x, y) in enumerate(_POLES)
        for side in "lr"
    ]  # fmt: skip
    return plates + poles


def _top() -> list[Part]:
    x, _, z = _CAMERA
    lens = math.pi / 2
    foot = z - 0.02 - PLATES[1]
    return [
        Part("camera", "box", (0.066, 0.279, 0.04), (x - 0.033, 0, z), COAL, 0.5),
        Part("camera_foot", "cylinder", (0.02, 0, foot), (x - 0.033, 0, z - 0.02 - 0.5 * foot),
             BLACK, 0.064),
        Part("projector", "cylinder", (0.011, 0, 0.004), (x, 0.05, z), GLASS, pitch=lens),
        Part("colour_lens", "cylinder", (0.011, 0, 0.004), (x, 0.015, z), GLASS, pitch=lens),
        Part("depth_lens", "cylinder", (0.011, 0, 0.004), (x, -0.03, z), GLASS, pitch=lens),
        Part("computer", "box", (0.15, 0.2, 0.034), (_COMPUTER_X, 0, PLATES[0] + 0.02),
             SILVER, 1.446),
    ]  # fmt: skip


def parts(mass: float) -> list[Part]:
    """The body's parts, scaled to weigh ``mass`` (kg) together."""
    found = _base() + _stack() + _top()
    scale = mass / sum(p.mass for p in found)
    return [p._replace(mass=scale * p.mass) for p in found]


def balance(body: list[Part]) -> tuple[Vector, Vector]:
    """Centre of mass (m, from base_link) and moments of inertia about it (kg m^2).

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
