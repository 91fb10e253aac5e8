"""Robots that are not discs: gaps, contacts and times to contact of polygons and capsules."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError
from tests.plugins.metrics.scenes import (
    AGENT_RADIUS,
    ROBOT_RADIUS,
    grid,
    line,
    random_scene,
    scene,
    scores_of,
    value_of,
    values,
)

T = grid(10)
BOX = np.array([[-0.6, -0.2], [0.6, -0.2], [0.6, 0.2], [-0.6, 0.2]])
CAPSULE = np.array([[-0.5, 0.0], [0.5, 0.0]])


def facing(angle: float, agent: tuple[float, float], footprint: Any) -> Trajectories:
    """A robot that stands, turned by an angle, and somebody who stands."""
    run = scene(T, line(T, (0, 0), (0, 0)), [line(T, agent, (0, 0))], robot_footprint=footprint)
    assert run.robot is not None
    return dataclasses.replace(run, robot=dataclasses.replace(run.robot, theta=0 * T + angle))


@pytest.mark.parametrize(
    ("footprint", "angle", "agent", "gap"),
    [
        (BOX, 0.0, (2.0, 0.0), 1.4),
        (BOX, np.pi / 2, (2.0, 0.0), 1.8),
        (BOX, np.pi / 2, (0.0, -2.0), 1.4),
        (BOX, 0.0, (0.9, 0.6), 0.5),
        (BOX[::-1], 0.0, (2.0, 0.0), 1.4),
        (BOX, 0.0, (0.0, 0.1), -0.1),
        (CAPSULE, 0.0, (2.0, 0.0), 1.5 - ROBOT_RADIUS),
        (CAPSULE, np.pi / 2, (2.0, 0.0), 2.0 - ROBOT_RADIUS),
        (CAPSULE, 0.0, (0.8, 0.4), 0.5 - ROBOT_RADIUS),
        (CAPSULE, 0.0, (0.2, 0.1), 0.1 - ROBOT_RADIUS),
    ],
)
def test_gaps(footprint: Any, angle: float, agent: tuple[float, float], gap: float) -> None:
    run = facing(angle, agent, footprint)
    assert value_of(scores_of("min_clearance", run)) == pytest.approx(gap - AGENT_RADIUS)


@pytest.mark.parametrize(
    ("footprint", "reach"), [(BOX, np.hypot(0.6, 0.2)), (CAPSULE, 0.5 + ROBOT_RADIUS)]
)
def test_the_reading_of_a_disc_stays_as_a_variant(footprint: Any, reach: float) -> None:
    """Somebody stands beside a long robot, 0.9 m from its middle."""
    run = facing(0.0, (0.0, 0.9), footprint)
    half = 0.2 if footprint is BOX else ROBOT_RADIUS
    gaps = {"outline": 0.9 - half - AGENT_RADIUS, "disc": 0.9 - reach - AGENT_RADIUS}
    assert values(scores_of("min_clearance", run)) == pytest.approx(
        {"corrected": gaps["outline"], "disc": gaps["disc"]}
    )
    near = scores_of("proximity", run)
    assert value_of(near) == pytest.approx(1 / 0.9)  # of centres
    assert value_of(near, "outline") == pytest.approx(1 / gaps["outline"])


def test_times_to_contact_of_a_disc() -> None:
    """Somebody comes from the side: the disc would be touched earlier."""
    run = scene(T, line(T, (0, 0), (0, 0)), [line(T, (0.0, 9.0), (0.0, -0.5))], robot_footprint=BOX)
    least = values(scores_of("min_time_to_collision", run))
    apart = 9.0 - 0.5 * 10 - AGENT_RADIUS
    assert least == pytest.approx(
        {"corrected": (apart - 0.2) / 0.5, "disc": (apart - np.hypot(0.6, 0.2)) / 0.5}
    )
    risk = scores_of("risk", run, risk_horizon="9 s")
    assert value_of(risk, "disc") > value_of(risk, "rate") > 0


def test_a_round_robot_reads_alike_either_way() -> None:
    run = random_scene(3)
    for metric, outline in (("min_clearance", "corrected"), ("risk", "rate")):
        found = values(scores_of(metric, run))
        assert found["disc"] == found[outline]


def test_contact_is_with_the_outline() -> None:
    """Somebody comes from the front; the disc would be touched later, at the side earlier."""
    for start, velocity, onset in (
        ((5.0, 0.0), (-1.0, 0.0), 5.0 - 0.6 - AGENT_RADIUS),
        ((0.0, 5.0), (0.0, -1.0), 5.0 - 0.2 - AGENT_RADIUS),
    ):
        run = scene(T, line(T, (0, 0), (0, 0)), [line(T, start, velocity)], robot_footprint=BOX)
        found = scores_of("collision_count", run)
        assert values(found) == {"literal": 1, "corrected": 1}
        assert found["corrected"].extras["first_time"] == pytest.approx(onset)
        before = np.maximum(0, onset - T[onset > T])
        inside = int(((onset <= T) & (10 - onset + 1e-9 >= T)).sum())
        literal = value_of(scores_of("risk", run), "literal")
        assert literal == pytest.approx(before.sum())
        exposed = value_of(scores_of("risk", run), "exposed_time")
        assert exposed == pytest.approx(0.1 * (len(before) + inside) - 0.05, abs=1e-6)


def test_tunnelling_through_a_polygon() -> None:
    t = np.array([0.0, 1.0, 2.0])
    run = scene(t, line(t, (0, 0), (0, 0)), [line(t, (0.5, 8), (0, -9))], robot_footprint=BOX)
    assert values(scores_of("collision_count", run)) == {"literal": 0, "corrected": 1}
    run = scene(t, line(t, (0, 0), (0, 0)), [line(t, (0.9, 8), (0, -9))], robot_footprint=BOX)
    assert values(scores_of("collision_count", run)) == {"literal": 0, "corrected": 0}


@pytest.mark.parametrize("radius", [ROBOT_RADIUS, 0.3])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_a_capsule_without_length_is_a_disc(radius: float, seed: int) -> None:
    run = random_scene(seed)
    assert run.robot is not None
    robot = dataclasses.replace(run.robot, radius=radius)
    disc = dataclasses.replace(run, robot=robot)
    point = dataclasses.replace(disc, robot_footprint=np.zeros((2, 2)))
    for metric in ("collision_count", "collision_severity", "risk", "min_clearance"):
        a, b = scores_of(metric, disc), scores_of(metric, point)
        for variant, one in a.items():
            assert b[variant].status == one.status
            if one.value is not None:
                assert b[variant].value == pytest.approx(one.value, rel=1e-6, abs=1e-6)


@given(
    start=st.tuples(st.floats(-4, 4), st.floats(-4, 4)),
    step=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    reach=st.floats(0.05, 1),
)
@settings(max_examples=200)
def test_first_touch_is_where_the_gap_is_the_reach(
    start: tuple[float, float], step: tuple[float, float], reach: float
) -> None:
    for outline in (Footprint(BOX, 0.0), Footprint(CAPSULE, 0.18)):
        x, y, dx, dy = (np.array([[v]]) for v in (*start, *step))
        if outline.gap(x, y)[0, 0] <= reach + 1e-6:
            continue
        s = outline.first_touch(x, y, dx, dy, np.array([reach]))
        grid_s = np.linspace(0, min(1.0, s[0, 0]), 400)[:, None]
        along = outline.gap(x + grid_s * dx, y + grid_s * dy)
        assert along.min() >= reach - 1e-7
        if s[0, 0] <= 1:
            assert along[-1, 0] == pytest.approx(reach, abs=1e-7)


def test_outlines_that_are_none() -> None:
    for bad in (np.zeros((1, 2)), np.zeros((4, 3)), np.zeros(4), [[0.0, np.nan], [1.0, 0.0]]):
        with pytest.raises(InputError, match="robot_footprint"):
            scene(T, line(T, (0, 0), (0, 0)), robot_footprint=bad)
