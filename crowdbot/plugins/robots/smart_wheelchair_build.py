"""Build the Smart Wheelchair as SDFormat text from primitives.

Sources: UCL's platform, a Sunrise Quickie Salsa M2 with mid-wheel drive, six wheels, 0.61 m at its
widest, up to 10 km/h (IEEE Robotics and Automation Magazine, March 2023, p. 26). Wheel radius,
track, masses, height and positions of the parts are proposed.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

import crowdbot.plugins.robots.sdf as sdf
from crowdbot.plugin import RobotModel
from crowdbot.plugins.robots.body_part import (
    BLACK,
    BLUE,
    COAL,
    GREY,
    SKIN,
    Part,
    balance,
    scaled,
)
from crowdbot.plugins.robots.limits_build import limits_of, two_wheels
from crowdbot.plugins.robots.smart_wheelchair import SmartWheelchairSpec

TRACK, HEIGHT = 0.52, 1.35
WHEEL = sdf.Wheel(0.165, width=0.06, hub_width=0.065, mass=6.0, effort=60.0, slim=True)
CASTER_RADIUS = 0.08
_CASTERS = (0.38, 0.2)  # m ahead of and behind the axle, and to the sides
_SOLE = 0.04  # m, shell above the floor


def parts() -> list[Part]:
    """Return chassis, seat, foot rests, joystick and seated driver; from the axle, m and kg."""
    z = -WHEEL.radius
    legs = [
        part
        for side, y in (("left", 0.11), ("right", -0.11))
        for part in (
            Part(f"{side}_thigh", "box", (0.44, 0.14, 0.13), (0.12, y, z + 0.6), BLUE, 9.0),
            Part(f"{side}_shank", "box", (0.1, 0.1, 0.4), (0.38, y, z + 0.36), BLUE, 4.0),
            Part(f"{side}_foot", "box", (0.2, 0.09, 0.08), (0.44, y, z + 0.15), BLACK, 1.0),
            Part(f"{side}_arm", "box", (0.34, 0.07, 0.07), (0.05, 2.1 * y, z + 0.78), BLUE, 3.5),
            Part(f"{side}_rest", "box", (0.3, 0.06, 0.03), (0.05, 2.3 * y, z + 0.72), COAL, 1.0),
        )
    ]  # fmt: skip
    casters = [
        Part(f"caster_{i}", "cylinder", (CASTER_RADIUS, 0, 0.04), (x, y, z + CASTER_RADIUS), BLACK,
             2.0, pitch=math.pi / 2)
        for i, (x, y) in enumerate(_caster_places())
    ]  # fmt: skip
    return [
        Part("chassis", "box", (0.72, 0.4, 0.18), (-0.04, 0, z + 0.26), COAL, 62.0),
        Part("batteries", "box", (0.34, 0.36, 0.12), (-0.1, 0, z + 0.4), BLACK, 32.0),
        Part("seat", "box", (0.46, 0.46, 0.06), (0.02, 0, z + 0.5), GREY, 6.0),
        Part("backrest", "box", (0.06, 0.44, 0.56), (-0.24, 0, z + 0.8), GREY, 5.0),
        Part("foot_rest", "box", (0.18, 0.36, 0.02), (0.45, 0, z + 0.1), BLACK, 2.0),
        Part("joystick", "cylinder", (0.012, 0, 0.08), (0.22, -0.25, z + 0.78), BLACK, 0.3),
        *casters,
        *legs,
        Part("trunk", "box", (0.22, 0.36, 0.5), (-0.1, 0, z + 0.87), BLUE, 33.0),
        Part("head", "cylinder", (0.09, 0, 0.22), (-0.08, 0, z + 1.24), SKIN, 5.0),
        Part("hair", "cylinder", (0.095, 0, 0.03), (-0.08, 0, z + 1.335), BLACK, 0.1),
    ]


def _caster_places() -> list[tuple[float, float]]:
    ahead, aside = _CASTERS
    return list(itertools.product((ahead, -ahead), (aside, -aside)))


def build(spec: SmartWheelchairSpec) -> RobotModel:
    """Return the model with this spec's mass and limits. Contact is at its centre's height."""
    share = spec.mass / 205.0
    wheels = 2.0 * WHEEL.mass
    body = scaled(parts(), spec.mass - wheels)
    (_, _, z), _ = balance(body)
    centre = ((spec.mass - wheels) * (z + WHEEL.radius) + wheels * WHEEL.radius) / spec.mass
    across, along = 0.5 * spec.width, 0.5 * spec.length
    corners = [[along, across], [-along, across], [-along, -across], [along, -across]]
    return RobotModel(
        description=_text(body, spec, WHEEL._replace(effort=WHEEL.effort * share)),
        base="base_link",
        base_height=WHEEL.radius,
        drive=two_wheels(TRACK, WHEEL.radius),
        limits=limits_of(spec),
        footprint_radius=math.hypot(across, along),
        footprint=np.array(corners),
        height=HEIGHT,
        force_height=centre,
        mass=spec.mass,
    )


def _text(body: list[Part], spec: SmartWheelchairSpec, wheel: sdf.Wheel) -> str:
    length = HEIGHT - _SOLE
    z = _SOLE + 0.5 * length - wheel.radius
    return sdf.model(
        "smart_wheelchair",
        sdf.base_link(
            body,
            sdf.collision("body", (0.0, 0.0, z), sdf.box(spec.length, spec.width, length), 0.3),
            *(
                sdf.slider(f"slider_{i}", (x, y, CASTER_RADIUS - wheel.radius), CASTER_RADIUS)
                for i, (x, y) in enumerate(_caster_places())
            ),
        ),
        sdf.wheels(TRACK, 0.0, wheel),
    )
