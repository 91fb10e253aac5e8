"""Build TurtleBot2 as SDFormat text from primitives.

Sources: Kobuki and TurtleBot2 data sheets and descriptions (dimensions, encoder, limits); masses
are in `crowdbot.plugins.robots.turtlebot2_parts`.
"""

from __future__ import annotations

import crowdbot.plugins.robots.sdf as sdf
from crowdbot.plugin import RobotModel
from crowdbot.plugins.robots.body_part import balance
from crowdbot.plugins.robots.limits_build import limits_of, two_wheels
from crowdbot.plugins.robots.turtlebot2 import Turtlebot2Spec
from crowdbot.plugins.robots.turtlebot2_parts import parts

WHEEL_RADIUS = 0.0352  # actual radius, m; the firmware assumes 0.035
TRACK = 0.230
BODY_RADIUS = 0.178
BODY_HEIGHT = 0.42
SKIRT, TOP = 0.0162, 0.41  # lower and upper edge of the collision shapes above the floor, m
BASE_HEIGHT = 0.0102  # base_link above the floor
CASTER_RADIUS = 0.017
CASTERS = {"front": 0.115, "rear": -0.135}
WHEEL_MASS = 0.15
WHEEL = sdf.Wheel(WHEEL_RADIUS, width=0.0206, hub_width=0.022, mass=WHEEL_MASS, effort=1.0)


def build(spec: Turtlebot2Spec) -> RobotModel:
    """Return the model with this spec's mass and limits. Contact is at its centre's height."""
    body = spec.mass - 2.0 * WHEEL_MASS
    (_, _, z), _ = balance(parts(body))
    centre = (body * (z + BASE_HEIGHT) + 2.0 * WHEEL_MASS * WHEEL_RADIUS) / spec.mass
    return RobotModel(
        description=_sdf(spec.mass),
        base="base_link",
        base_height=BASE_HEIGHT,
        drive=two_wheels(TRACK, WHEEL_RADIUS),
        limits=limits_of(spec),
        footprint_radius=BODY_RADIUS,
        height=BODY_HEIGHT,
        force_height=centre,
        mass=spec.mass,
    )


def _sdf(mass: float) -> str:
    foot = CASTER_RADIUS - BASE_HEIGHT
    tall = TOP - SKIRT
    return sdf.model(
        "turtlebot2",
        sdf.base_link(
            parts(mass - 2.0 * WHEEL_MASS),
            sdf.collision(
                "body",
                (0.0, 0.0, SKIRT + 0.5 * tall - BASE_HEIGHT),
                sdf.cylinder(BODY_RADIUS, tall),
                0.3,
            ),
            *(sdf.slider(f"{n}_caster", (x, 0.0, foot), CASTER_RADIUS) for n, x in CASTERS.items()),
        ),
        sdf.wheels(TRACK, WHEEL_RADIUS - BASE_HEIGHT, WHEEL),
    )
