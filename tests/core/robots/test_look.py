"""What a robot looks like, from above and for cameras."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.registry.registry import discover
from crowdbot.core.robots.build import build_model
from crowdbot.core.robots.look import seen_from_above, visual_parts

REGISTRY = discover(allow=())
ROBOTS = ("turtlebot2", "pepper", "qolo", "cuybot", "smart_wheelchair")
URDF = """<robot name="r"><material name="red"><color rgba="1 0 0 1"/></material>
<link name="base_link"><inertial><mass value="1"/></inertial>
  <visual><origin xyz="1 2 0.5" rpy="0 0 1.5707963267948966"/>
    <geometry><box size="0.4 0.2 0.1"/></geometry><material name="red"/></visual>
  <visual><geometry><sphere radius="0.5"/></geometry></visual>
  <visual><geometry><mesh filename="x.stl"/></geometry></visual>
</link></robot>"""


def area(outline: NDArray[np.float64]) -> float:
    x, y = outline.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_shapes_of_a_urdf_are_projected() -> None:
    spec = REGISTRY.find("robot", "pepper").spec()
    model = replace(build_model(REGISTRY, spec), description=URDF, base="base_link")
    ball, box = seen_from_above(model)
    assert (ball.colour, box.colour) == ("#8a8d91", "#ff0000")
    assert (ball.top, box.top) == pytest.approx((0.5, 0.55))
    assert area(ball.outline) == pytest.approx(math.pi * 0.25, rel=0.02)
    assert area(box.outline) == pytest.approx(0.08)
    assert box.outline.min(axis=0) == pytest.approx([0.9, 1.8])
    assert box.outline.max(axis=0) == pytest.approx([1.1, 2.2])


def test_visual_parts_are_the_shapes_in_the_frame_of_the_base() -> None:
    spec = REGISTRY.find("robot", "pepper").spec()
    model = replace(build_model(REGISTRY, spec), description=URDF, base="base_link")
    box, ball = visual_parts(model)
    assert (box.colour, ball.colour) == ("#ff0000", "#8a8d91")
    assert box.corners.min(axis=0) == pytest.approx([0.9, 1.8, 0.45])
    assert box.corners.max(axis=0) == pytest.approx([1.1, 2.2, 0.55])
    assert np.hypot(*ball.corners.T[:2]).max() == pytest.approx(0.5)


@pytest.mark.parametrize("kind", ROBOTS)
def test_every_robot_is_drawn_within_its_outline(kind: str) -> None:
    """All but details of some centimetres lie inside what people and walls touch."""
    model = build_model(REGISTRY, REGISTRY.find("robot", kind).spec())
    body, parts = footprint_of_model(model), seen_from_above(model)
    assert len({part.colour for part in parts}) >= 3
    assert [p.top for p in parts] == sorted(p.top for p in parts)
    for part in parts:
        assert area(part.outline) > 0.0
        x, y = part.outline.T
        beyond = body.gap(x, y) if len(body.corners) else np.hypot(x, y) - body.radius
        assert np.all(beyond < 0.04), part
    widest = max(area(p.outline) for p in parts)
    assert widest > 0.25 * math.pi * 0.17**2
