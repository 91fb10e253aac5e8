"""Clearance, times to contact, risk of outlines, against shapely on random worlds."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar
from shapely import affinity  # type: ignore[import-untyped]
from shapely.geometry import LineString, MultiPoint, Point  # type: ignore[import-untyped]

from crowdbot.core.trajectories.encounters import (
    encounter,
    relative_velocity,
    time_to_contact,
)
from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics import oracle
from tests.plugins.metrics.scenes import random_scene, scores_of, value_of

JUMP_SPEED, CONTACT_TOL, STILL = 10.0, 1e-9, 1e-9


def world(seed: int) -> tuple[Trajectories, Any, float]:
    """A random run; its robot's outline before rounding, for shapely, and the rounding, m."""
    rng = np.random.default_rng(seed)
    run = random_scene(seed)
    assert run.robot is not None
    theta = rng.uniform(-np.pi, np.pi, len(run.t))
    robot = dataclasses.replace(run.robot, theta=theta, goal_time=None)
    if seed % 2:
        ends = rng.uniform(-0.6, 0.6, (2, 2))
        shape, footprint, rounding = LineString(ends), ends, robot.radius
    else:
        hull = MultiPoint(rng.uniform(-0.7, 0.7, (7, 2))).convex_hull
        shape, footprint, rounding = hull, np.array(hull.exterior.coords)[:-1], 0.0
    return dataclasses.replace(run, robot=robot, robot_footprint=footprint), shape, rounding


def placed(run: Trajectories, shape: Any, k: int) -> Any:
    """The outline where the robot is at sample k."""
    assert run.robot is not None
    turned = affinity.rotate(shape, run.robot.theta[k], origin=(0, 0), use_radians=True)
    return affinity.translate(turned, run.robot.x[k], run.robot.y[k])


@pytest.mark.parametrize("seed", range(8))
def test_gaps_and_the_least_clearance(seed: int) -> None:
    run, shape, rounding = world(seed)
    assert run.agents is not None
    pair = encounter(run, JUMP_SPEED)
    wanted = np.full(pair.gap.shape, np.nan)
    for k in range(len(run.t)):
        body = placed(run, shape, k)
        for m, radius in enumerate(run.agents.radius):
            point = Point(run.agents.x[k, m], run.agents.y[k, m])
            if np.isfinite(run.agents.x[k, m]):
                depth = body.exterior.distance(point) if body.contains(point) else 0.0
                wanted[k, m] = body.distance(point) - depth - rounding - radius
    assert np.allclose(pair.gap, wanted, atol=1e-9, rtol=0.0, equal_nan=True)
    found = scores_of("min_clearance", run)["corrected"]
    if found.value is not None:
        assert value_of({"corrected": found}) == pytest.approx(np.nanmin(wanted), abs=1e-6)


@pytest.mark.parametrize("seed", range(8))
def test_times_to_contact(seed: int) -> None:
    run, shape, rounding = world(seed)
    assert run.agents is not None
    pair, velocity = encounter(run, JUMP_SPEED), relative_velocity(run, JUMP_SPEED)
    tau = time_to_contact(pair, velocity, contact_tol=CONTACT_TOL, rel_speed_tol=STILL)
    for k in range(0, len(run.t), max(1, len(run.t) // 5)):
        body = placed(run, shape, k)
        for m, radius in enumerate(run.agents.radius):
            x, y = run.agents.x[k, m], run.agents.y[k, m]
            vx, vy = velocity[0][k, m], velocity[1][k, m]
            if not np.all(np.isfinite([x, y, vx, vy])) or np.hypot(vx, vy) < 1e-3:
                continue

            def gap(
                s: float, x: float = x, y: float = y, vx: float = vx, vy: float = vy,
                body: Any = body, reach: float = rounding + radius,
            ) -> float:  # fmt: skip
                return float(body.distance(Point(x + s * vx, y + s * vy)) - reach)

            if gap(0.0) <= CONTACT_TOL:
                assert tau[k, m] == 0.0
                continue
            # The distance from a convex outline along a line is convex.
            nearest = minimize_scalar(gap, bounds=(0.0, 60.0), options={"xatol": 1e-9}).x
            if gap(nearest) > 1e-4:
                assert not tau[k, m] < 60.0
            elif gap(nearest) < -1e-4:
                assert tau[k, m] == pytest.approx(brentq(gap, 0.0, nearest, xtol=1e-12), abs=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_risk_severity_and_exposure(seed: int) -> None:
    """The sums of the plain loops, with times to contact that shapely and a root search give."""
    run, shape, rounding = world(seed)
    plain = oracle.World(run)
    bodies = [placed(run, shape, k) for k in range(plain.n)]

    def contact(known: oracle.World, k: int, i: int) -> float:
        at, velocity = known.at(k, i), known.relative_velocity(k, i)
        if at is None:
            return math.inf
        reach = rounding + float(known.agents.radius[i])

        def gap(s: float, vx: float = 0.0, vy: float = 0.0) -> float:
            return float(bodies[k].distance(Point(at[0] + s * vx, at[1] + s * vy))) - reach

        if gap(0.0) <= CONTACT_TOL:
            return 0.0
        if velocity is None or math.hypot(*velocity) <= oracle.SLOW:
            return math.inf
        speed = math.hypot(*velocity)
        last = (math.hypot(at[0] - run_x[k], at[1] - run_y[k]) + 2.0 + reach) / speed
        nearest = minimize_scalar(
            gap, args=velocity, bounds=(0.0, last), method="bounded", options={"xatol": 1e-10}
        ).x
        if gap(nearest, *velocity) > 0.0:
            return math.inf
        return float(brentq(gap, 0.0, nearest, args=velocity, xtol=1e-13))

    assert run.robot is not None
    run_x, run_y = run.robot.x, run.robot.y
    expected = oracle.risk(plain, contact)
    risk, severity = scores_of("risk", run), scores_of("expected_severity", run)
    assert expected["corrected"] > 0.0
    for variant in ("literal", "corrected", "exposed_time"):
        assert risk[variant].value == pytest.approx(expected[variant], rel=1e-6, abs=1e-6)
    for variant in ("literal", "corrected"):
        wanted = expected[f"severity_{variant}"]
        assert severity[variant].value == pytest.approx(wanted, rel=1e-6, abs=1e-6)
    exposed = scores_of("time_exposed", run)["corrected"].value
    assert exposed == pytest.approx(expected["exposed_time"], abs=1e-6)
