"""Build Pepper as SDFormat text from primitives.

Sources: the pepper_robot description of ros-naoqi (wheels at (0.09, +-0.155), (-0.17, 0), radius
0.07 m, 3.25 N m each; masses of the links), the maker's press sheet (1.21 m, 28 kg). The contact
disc of 0.27 m encloses the three bumpers, at (0.129, +-0.227) and (-0.251, 0); it is proposed, as
are shapes and positions of the parts, chosen so that the robot balances.
"""

from __future__ import annotations

import math

import crowdbot.plugins.robots.sdf as sdf
from crowdbot.plugin import HolonomicDrive, RobotModel
from crowdbot.plugins.robots.body_part import (
    BLACK,
    COAL,
    GLASS,
    GREY,
    WHITE,
    Part,
    balance,
    scaled,
)
from crowdbot.plugins.robots.limits_build import limits_of
from crowdbot.plugins.robots.pepper import PepperSpec

RADIUS, HEIGHT = 0.27, 1.21
WHEELS = {"front_left": (0.09, 0.155), "front_right": (0.09, -0.155), "rear": (-0.17, 0.0)}
WHEEL_RADIUS = 0.07
WHEEL_TORQUE = 3.25  # N m
#: Wheels at 120 degrees, each with force f at most, give 1.5 f in their worst direction, and turn
#: with 3 f at their mean distance from the centre.
MAX_FORCE = 1.5 * WHEEL_TORQUE / WHEEL_RADIUS
MAX_TORQUE = WHEEL_TORQUE / WHEEL_RADIUS * sum(math.hypot(x, y) for x, y in WHEELS.values())
_SOLE = 0.02  # m, shell above the floor


def parts() -> list[Part]:
    """Return base with wheels, leg, hip, torso, tablet, arms, head; from the floor, m and kg."""
    wheels = [
        Part(f"wheel_{n}", "cylinder", (WHEEL_RADIUS, 0, 0.04), (x, y, 0.09), COAL, 1.58)
        for n, (x, y) in WHEELS.items()
    ]
    arms = [
        part
        for side, y in (("left", 0.185), ("right", -0.185))
        for part in (
            Part(f"{side}_shoulder", "cylinder", (0.05, 0, 0.1), (-0.05, y, 0.92), WHITE, 0.5),
            Part(f"{side}_arm", "box", (0.07, 0.06, 0.24), (-0.03, y, 0.79), WHITE, 0.5),
            Part(f"{side}_hand", "box", (0.2, 0.05, 0.06), (0.07, y, 0.67), GREY, 0.4),
        )
    ]  # fmt: skip
    return [
        *wheels,
        Part("base", "cylinder", (0.235, 0, 0.2), (-0.01, 0, 0.13), WHITE, 8.0),
        Part("leg", "cylinder", (0.11, 0, 0.4), (-0.01, 0, 0.43), WHITE, 3.6),
        Part("hip", "box", (0.17, 0.2, 0.14), (-0.01, 0, 0.69), GREY, 3.48),
        Part("torso", "box", (0.17, 0.26, 0.24), (-0.01, 0, 0.87), WHITE, 4.0),
        Part("tablet", "box", (0.02, 0.25, 0.18), (0.11, 0, 0.86), BLACK, 0.4, pitch=-0.3),
        Part("neck", "cylinder", (0.04, 0, 0.05), (-0.02, 0, 1.01), COAL, 0.2),
        Part("head", "cylinder", (0.095, 0, 0.17), (-0.01, 0, 1.12), WHITE, 1.3),
        Part("left_eye", "box", (0.01, 0.03, 0.03), (0.085, 0.035, 1.13), GLASS),
        Part("right_eye", "box", (0.01, 0.03, 0.03), (0.085, -0.035, 1.13), GLASS),
        *arms,
    ]


def build(spec: PepperSpec) -> RobotModel:
    """Return the model with this spec's mass and limits. Contact is at its centre's height."""
    body = scaled(parts(), spec.mass)
    (_, _, centre), _ = balance(body)
    return RobotModel(
        description=_text(body),
        base="base_link",
        base_height=0.0,
        drive=HolonomicDrive(
            max_force=MAX_FORCE * spec.mass / 28.7,
            max_torque=MAX_TORQUE * spec.mass / 28.7,
            wheel_radius=WHEEL_RADIUS,
            track=0.31,
        ),
        limits=limits_of(spec, sideways=True),
        footprint_radius=RADIUS,
        height=HEIGHT,
        force_height=centre,
        mass=spec.mass,
    )


def _text(body: list[Part]) -> str:
    length = HEIGHT - _SOLE
    shell = sdf.cylinder(RADIUS, length)
    return sdf.model(
        "pepper",
        sdf.base_link(
            body,
            sdf.collision("body", (0.0, 0.0, _SOLE + 0.5 * length), shell, 0.3),
            *(sdf.slider(n, (x, y, WHEEL_RADIUS), WHEEL_RADIUS) for n, (x, y) in WHEELS.items()),
        ),
    )
