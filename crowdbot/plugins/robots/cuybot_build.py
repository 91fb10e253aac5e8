"""Build CuyBot as SDFormat text from primitives.

Source: the original's prefab: an omnidirectional rigid body of 100 kg, base box 0.573 m x 0.532 m
from 0.02 to 0.33 m, column from x = 0.02 to 0.305, y = -0.129 to 0.129 up to 1.29 m, leaning by 4
degrees. Limits, part masses, drive force and skin are proposed.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

import crowdbot.plugins.robots.sdf as sdf
from crowdbot.plugin import HolonomicDrive, RobotModel
from crowdbot.plugins.robots.body_part import (
    BLACK,
    COAL,
    GLASS,
    ORANGE,
    WHITE,
    Part,
    balance,
    scaled,
)
from crowdbot.plugins.robots.cuybot import CuybotSpec
from crowdbot.plugins.robots.limits_build import limits_of

LENGTH, WIDTH, HEIGHT = 0.573, 0.532, 1.29
WHEEL_RADIUS = 0.06
_SOLE = 0.02  # m, base above the floor
_FEET = (0.2, 0.2)  # m, wheels from the middle


def parts() -> list[Part]:
    """Return base with skin, column and head; from the floor, m and kg."""
    lean = math.radians(4.0)
    return [
        Part("base", "box", (0.53, 0.49, 0.27), (0, 0, 0.16), COAL, 70.0),
        Part("skin", "box", (LENGTH, WIDTH, 0.18), (0, 0, 0.15), ORANGE, 4.0),
        Part("deck", "box", (0.5, 0.46, 0.03), (0, 0, 0.315), WHITE, 4.0),
        Part("column", "box", (0.16, 0.22, 0.86), (0.13, 0, 0.76), WHITE, 16.0, pitch=lean),
        Part("panel", "box", (0.02, 0.2, 0.28), (0.25, 0, 1.05), BLACK, 2.0, pitch=lean),
        Part("lens", "cylinder", (0.02, 0, 0.01), (0.245, 0, 1.24), GLASS, pitch=math.pi / 2),
        Part("head", "box", (0.14, 0.25, 0.1), (0.17, 0, 1.24), ORANGE, 4.0),
    ]


def build(spec: CuybotSpec) -> RobotModel:
    """Return the model with this spec's mass, limits and softness.

    Contact forces act at the height of its centre of mass.
    """
    body = scaled(parts(), spec.mass)
    (_, _, centre), _ = balance(body)
    half = 0.5 * np.array([LENGTH, WIDTH])
    return RobotModel(
        description=_text(body),
        base="base_link",
        base_height=0.0,
        drive=HolonomicDrive(
            max_force=spec.yield_force,
            max_torque=spec.yield_force * math.hypot(*_FEET),
            wheel_radius=WHEEL_RADIUS,
            track=2.0 * _FEET[1],
        ),
        limits=limits_of(spec, sideways=True),
        footprint_radius=0.5 * math.hypot(LENGTH, WIDTH),
        footprint=half * [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]],
        height=HEIGHT,
        force_height=centre,
        mass=spec.mass,
        skin_stiffness=spec.skin_stiffness,
    )


def _text(body: list[Part]) -> str:
    length = HEIGHT - _SOLE
    shell = sdf.box(LENGTH, WIDTH, length)
    feet = itertools.product((_FEET[0], -_FEET[0]), (_FEET[1], -_FEET[1]))
    return sdf.model(
        "cuybot",
        sdf.base_link(
            body,
            sdf.collision("body", (0.0, 0.0, _SOLE + 0.5 * length), shell, 0.3),
            *(
                sdf.slider(f"wheel_{i}", (x, y, WHEEL_RADIUS), WHEEL_RADIUS)
                for i, (x, y) in enumerate(feet)
            ),
        ),
    )
