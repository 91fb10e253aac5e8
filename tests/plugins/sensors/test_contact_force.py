"""The contact force sensor: the resultant of people's pushes, seen from its mount."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Mount, Pose
from crowdbot.plugins.sensors.contact_force import ContactForceSpec
from crowdbot.plugins.sensors.contact_force_build import build
from crowdbot.testing.sensor_scenes import context

Push = tuple[float, float, float]
NEWTONS = st.floats(-300.0, 300.0)
METRES = st.floats(-1.0, 1.0)
ANGLES = st.floats(-math.pi, math.pi)


def felt(
    spec: ContactForceSpec, push: Push, yaw: float = 0.0, seed: int = 0
) -> NDArray[np.float64]:
    scene = Scene((), (0.0, 2.5), (), ())
    scene.update(None, np.zeros((0, 4)), np.zeros(0, np.bool_), push=push)
    rng = np.random.default_rng(seed)
    return np.asarray(build(spec, context()).read(scene, Pose(3.0, -2.0, yaw), 0.0, rng))


def test_nobody_pushes() -> None:
    assert felt(ContactForceSpec(), (0.0, 0.0, 0.0)).tolist() == [0.0, 0.0, 0.0]


@given(NEWTONS, NEWTONS, METRES, METRES, ANGLES, ANGLES, METRES, METRES)
def test_a_force_at_a_point_is_what_the_mount_feels(
    fx: float, fy: float, px: float, py: float, yaw: float, turn: float, mx: float, my: float
) -> None:
    """With rotation matrices: force and point of attack go into the frame of the mount."""

    def rotation(angle: float) -> NDArray[np.float64]:
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s], [s, c]])

    force, point = np.array([fx, fy]), np.array([px, py])  # world; from the base
    spec = ContactForceSpec(mount=Mount(x=mx, y=my, yaw=turn))
    got = felt(spec, (fx, fy, px * fy - py * fx), yaw)
    arm = rotation(yaw + turn).T @ (point - rotation(yaw) @ [mx, my])
    there = rotation(yaw + turn).T @ force
    assert got[:2] == pytest.approx(there, abs=1e-9)
    assert got[2] == pytest.approx(arm[0] * there[1] - arm[1] * there[0], abs=1e-8)


def test_a_force_beyond_its_range_keeps_its_direction() -> None:
    got = felt(ContactForceSpec(force_max=100.0), (300.0, -400.0, 50.0))
    assert got == pytest.approx([60.0, -80.0, 10.0])


def test_noise_is_of_the_size_that_the_spec_says() -> None:
    spec = ContactForceSpec(noise=2.0)
    rows = np.array([felt(spec, (10.0, 0.0, 0.0), seed=k) for k in range(400)])
    assert rows.mean(axis=0) == pytest.approx([10.0, 0.0, 0.0], abs=0.4)
    assert rows.std(axis=0) == pytest.approx([2.0, 2.0, 2.0], rel=0.15)
