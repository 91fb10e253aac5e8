"""Build Qolo as SDFormat text from primitives.

Sources: EPFL's qolo_ros (track 0.548 m, axle 0.2 m above the floor, capsule of radius 0.4 m around
x = 0.051 and x = -0.515 m, limits) and the original's prefab (rear caster of 0.082 m radius at x =
-0.553 m, rider of 1.7 m). No mass is published: parts and their masses are proposed, with the
centre of mass far enough behind the axle that braking with 1.5 m/s^2 does not tip it.
"""

from __future__ import annotations

import math

import numpy as np

import crowdbot.plugins.robots.sdf as sdf
from crowdbot.plugin import RobotModel
from crowdbot.plugins.robots.body_part import (
    BLACK,
    BLUE,
    COAL,
    GREY,
    SILVER,
    SKIN,
    Part,
    balance,
    scaled,
)
from crowdbot.plugins.robots.limits_build import limits_of, two_wheels
from crowdbot.plugins.robots.qolo import QoloSpec

FRONT, REAR = 0.051, -0.515  # m, ends of the capsule's axis
TRACK, HEIGHT = 0.548, 1.7
WHEEL = sdf.Wheel(0.2, width=0.05, hub_width=0.055, mass=4.0, effort=60.0, slim=True)
CASTER_X, CASTER_RADIUS = -0.553, 0.082
_SOLE = 0.05  # m, shell above the floor


def parts() -> list[Part]:
    """Return frame, batteries, seat and standing rider; from base_link, which is the axle."""
    z = -WHEEL.radius
    rider = [
        Part(f"{side}_leg", "cylinder", (0.075, 0, 0.8), (-0.08, y, z + 0.55), BLUE, 11.0)
        for side, y in (("left", 0.11), ("right", -0.11))
    ]
    return [
        Part("frame", "box", (0.5, 0.42, 0.1), (-0.22, 0, z + 0.17), COAL, 17.0),
        Part("batteries", "box", (0.22, 0.36, 0.16), (-0.42, 0, z + 0.3), BLACK, 18.0),
        Part("mast", "box", (0.06, 0.3, 0.6), (-0.27, 0, z + 0.65), SILVER, 7.0),
        Part("backrest", "box", (0.05, 0.34, 0.26), (-0.23, 0, z + 1.0), GREY, 3.0),
        Part("knee_guard", "box", (0.05, 0.36, 0.12), (0.06, 0, z + 0.5), GREY, 2.0),
        *rider,
        Part("trunk", "box", (0.2, 0.36, 0.48), (-0.1, 0, z + 1.19), BLUE, 29.0),
        Part("head", "cylinder", (0.09, 0, 0.24), (-0.09, 0, z + 1.57), SKIN, 5.0),
        Part("hair", "cylinder", (0.095, 0, 0.03), (-0.09, 0, z + 1.685), BLACK, 0.1),
        Part("caster", "cylinder", (CASTER_RADIUS, 0, 0.04), (CASTER_X, 0, z + CASTER_RADIUS),
             BLACK, 2.0, pitch=math.pi / 2),
    ]  # fmt: skip


def build(spec: QoloSpec) -> RobotModel:
    """Return the model with this spec's mass and limits. Contact is at its centre's height."""
    share = spec.mass / 120.0
    body = scaled(parts(), spec.mass - 2.0 * WHEEL.mass)
    (_, _, z), _ = balance(body)
    wheels = 2.0 * WHEEL.mass
    centre = ((spec.mass - wheels) * (z + WHEEL.radius) + wheels * WHEEL.radius) / spec.mass
    return RobotModel(
        description=_text(body, spec.radius, WHEEL._replace(effort=WHEEL.effort * share)),
        base="base_link",
        base_height=WHEEL.radius,
        drive=two_wheels(TRACK, WHEEL.radius),
        limits=limits_of(spec),
        footprint_radius=spec.radius,
        footprint=np.array([[FRONT, 0.0], [REAR, 0.0]]),
        height=HEIGHT,
        force_height=centre,
        mass=spec.mass,
    )


def _text(body: list[Part], radius: float, wheel: sdf.Wheel) -> str:
    """Return two upright cylinders joined by a box: a capsule, seen from above."""
    length = HEIGHT - _SOLE
    z = _SOLE + 0.5 * length - wheel.radius
    end = sdf.cylinder(radius, length)
    return sdf.model(
        "qolo",
        sdf.base_link(
            body,
            sdf.collision("front", (FRONT, 0.0, z), end, 0.3),
            sdf.collision("rear", (REAR, 0.0, z), end, 0.3),
            sdf.collision(
                "between", (0.5 * (FRONT + REAR), 0.0, z),
                sdf.box(FRONT - REAR, 2.0 * radius, length), 0.3,
            ),
            sdf.slider("caster", (CASTER_X, 0.0, CASTER_RADIUS - wheel.radius), CASTER_RADIUS),
        ),
        sdf.wheels(TRACK, 0.0, wheel),
    )  # fmt: skip
