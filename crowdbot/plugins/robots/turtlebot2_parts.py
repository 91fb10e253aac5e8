"""Parts of a TurtleBot2's body: appearance and mass.

Sizes and positions are from the makers' descriptions of Kobuki and TurtleBot2. Masses: the data
sheets' 2.35 kg of the Kobuki (wheels included), 0.52 kg for each plate, 0.38 kg for all poles,
0.564 kg of the Kinect, and 1.446 kg for a small computer, which makes 6.3 kg with two wheels of
0.15 kg. The computer is on the lowest plate, placed so that the robot balances over the axle.
"""

from __future__ import annotations

import math

from crowdbot.plugins.robots.body_part import (
    BLACK,
    COAL,
    GLASS,
    GREEN,
    GREY,
    SILVER,
    WOOD,
    Part,
    scaled,
)

PLATES = (0.1204, 0.1772, 0.3864)  # heights of the plates' centres above base_link
_PLATE = 0.006  # thickness, m
_PLATE_X = -0.0136
_POLES = ((0.06, 0.135), (-0.105, 0.098))  # left ones; m
_CAMERA = (-0.087, 0.0, 0.287)
_COMPUTER_X = 0.0674


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
    # The poles share their mass in proportion to their length.
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
    """Return the body's parts, scaled to a total of ``mass`` (kg)."""
    return scaled(_base() + _stack() + _top(), mass)
