"""A low-poly person for images: a prism per leg, one for the trunk, and a head.

The proportions are those that sensors see (`crowdbot.core.sensing.body_model`); the head is added.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from crowdbot.core.sensing.body_model import BOTTOM, PARTS, RADIUS, TOP, X, Y, place_people
from crowdbot.core.types.arrays import Array

_SIDES = 8
_SHOULDER = 0.82  # share of the height: top of the drawn trunk
_HEAD = 0.055  # share of the height: radius of the head


def leg_obj(height: float, radius: float, hip: float = 0.0) -> str:
    """Return Wavefront OBJ text of an upright leg at the origin.

    Args:
        height: height of the person, m.
        radius: radius of the contact disc, m.
        hip: height of the hip, m; 0: default.
    """
    leg, _, _ = _discs(height, radius)
    leg[X] = leg[Y] = 0.0
    leg[TOP] = hip or leg[TOP]
    return _obj([leg])


def trunk_obj(height: float, radius: float, hip: float = 0.0) -> str:
    """Return the same for trunk and head of a person who stands at the origin."""
    *_, trunk = _discs(height, radius)
    trunk[TOP] = _SHOULDER * height
    trunk[BOTTOM] = hip or trunk[BOTTOM]
    head = np.array([0.0, 0.0, _HEAD * height, (_SHOULDER + 0.04) * height, height])
    return _obj([trunk, head])


def _discs(height: float, radius: float) -> Array:
    """Return legs and trunk as sensors see them."""
    discs = np.zeros((PARTS, 5))
    place_people(
        np.zeros((1, 4)), np.ones(1, np.bool_), np.array([[1.0, 0.0]]), np.zeros(1),
        np.array([radius]), np.array([height]), discs,
    )  # fmt: skip
    return discs


def _obj(discs: Iterable[Array]) -> str:
    vertices: list[Array] = []
    normals: list[Array] = []
    faces: list[str] = []
    for disc in discs:
        _prism(disc, vertices, normals, faces)
    lines = [f"v {v[0]:.6f} {v[1]:.6f} {v[2]:.6f}" for v in vertices]
    lines += [f"vn {n[0]:.6f} {n[1]:.6f} {n[2]:.6f}" for n in normals]
    return "\n".join([*lines, *faces]) + "\n"


def _prism(disc: Array, vertices: list[Array], normals: list[Array], faces: list[str]) -> None:
    """Add an upright prism with a flat top; its sides have round shading."""
    first, normal = len(vertices) + 1, len(normals) + 1
    turns = 2.0 * math.pi * np.arange(_SIDES) / _SIDES
    for turn in turns:
        out = np.array([math.cos(turn), math.sin(turn), 0.0])
        foot = np.array([disc[X], disc[Y], disc[BOTTOM]]) + disc[RADIUS] * out
        vertices += [foot, foot + np.array([0.0, 0.0, disc[TOP] - disc[BOTTOM]])]
        normals.append(out)
    normals.append(np.array([0.0, 0.0, 1.0]))
    for k in range(_SIDES):
        a, b = first + 2 * k, first + 2 * ((k + 1) % _SIDES)
        na, nb = normal + k, normal + (k + 1) % _SIDES
        faces.append(f"f {a}//{na} {b}//{nb} {b + 1}//{nb}")
        faces.append(f"f {a}//{na} {b + 1}//{nb} {a + 1}//{na}")
    up = normal + _SIDES
    for k in range(1, _SIDES - 1):
        a, b, c = first + 1, first + 2 * k + 1, first + 2 * k + 3
        faces.append(f"f {a}//{up} {b}//{up} {c}//{up}")
