"""Three rules that no test held: each case fails when its rule is left out of the metric."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from crowdbot.core.trajectories.trajectories import Trajectories
from tests.plugins.metrics.scenes import driven, grid, line, scene, scores_of, value_of

T = grid(10, 1 / 16)


def table(*rows: tuple[float, int]) -> dict[str, Any]:
    """Contacts at these times with these people."""
    t0 = np.array([t for t, _ in rows])
    return {
        "t0": t0, "t1": t0 + 0.1, "agent": np.array([a for _, a in rows], np.int64),
        "impulse": np.ones(len(rows)), "peak_force": np.ones(len(rows)),
        "relative_speed": np.ones(len(rows)),
    }  # fmt: skip


# ------------------------------------------------- first contacts are cut at arrival
def arriving(goal_time: float | None, *rows: tuple[float, int]) -> Trajectories:
    """One metre per second past people who stand 3 m and 7 m away."""
    people = [line(T, (3, 0), (0, 0)), line(T, (7, 0), (0, 0))]
    return scene(
        T, line(T, (0, 0), (1, 0)), people, goal_time=goal_time,
        robot_goal=(10.0, 0.0), robot_speed_limit=1.0, contacts=table(*rows) if rows else None,
    )  # fmt: skip


@pytest.mark.parametrize("recorded", [False, True])
def test_contacts_after_the_arrival_are_none(recorded: bool) -> None:
    rows = ((2.57, 0), (6.57, 1)) if recorded else ()
    whole, cut, early = (arriving(g, *rows) for g in (None, 5.0, 2.0))
    counts = [scores_of("collision_count", run)["corrected"] for run in (whole, cut, early)]
    assert [c.value for c in counts] == [2, 1, 0]
    assert counts[0].extras["first_time"] == counts[1].extras["first_time"]
    assert counts[0].extras["first_time"] == pytest.approx(2.57, abs=0.07)
    assert "first_time" not in counts[2].extras
    for metric, variant in (("collision_severity", "corrected"), ("contacts_at_fault", "corrected"),
                            ("collisions_at_fault", "robot")):  # fmt: skip
        values = [value_of(scores_of(metric, run), variant) for run in (whole, cut, early)]
        assert values[0] == pytest.approx(2 * values[1])
        assert values[1] > 0 == values[2]
    rates = [value_of(scores_of("collision_rate", run), "per_time") for run in (whole, cut, early)]
    assert rates == pytest.approx([2 / 10, 1 / 5, 0])


# ------------------------------- the frontal half-plane of collisions at fault
@pytest.mark.parametrize(("start", "velocity", "robot"), [
    ((2.4, 0.0), (0.0, 0.0), 1),  # before it
    ((1.6, 0.0), (0.0, 0.0), 0),  # behind it: it drives away
    ((2.0, 0.4), (0.0, 0.0), 0),  # exactly beside it
    ((2.01, 0.4), (0.0, 0.0), 1),
    ((1.99, 0.4), (0.0, 0.0), 0),
    ((2.4, 0.0), (1.5, 0.0), 0),  # before it, and faster
])  # fmt: skip
def test_who_is_behind_the_robot_is_at_fault_himself(
    start: tuple[float, float], velocity: tuple[float, float], robot: int
) -> None:
    """The robot is at (2, 0) at 2 s, at 1 m/s; somebody touches it there."""
    x, y = (s - 2.0 * v for s, v in zip(start, velocity, strict=True))
    run = scene(T, line(T, (0, 0), (1, 0)), [line(T, (x, y), velocity)], contacts=table((2.0, 0)))
    found = scores_of("collisions_at_fault", run)
    assert (value_of(found, "robot"), value_of(found, "person")) == (robot, 1 - robot)


# --------------------------------------------- what turning path_irregularity allows
@pytest.mark.parametrize(("rate", "needed"), [
    (lambda t: np.full(len(t), 0.1), 1.0),  # all of it is needed
    (lambda t: np.full(len(t), -0.1), 1.0),
    (lambda t: np.where(t < 5.0, 0.2, -0.2), 0.0),  # there and back
    (lambda t: np.where(t < 7.5, 0.2, -0.2), 1.0),  # half of it
])  # fmt: skip
def test_turning_that_is_needed_is_no_irregularity(rate: Any, needed: float) -> None:
    run = driven(T, v=1.0, w=rate(T))
    theta = run.robot.theta if run.robot is not None else np.zeros(1)
    turned = float(np.abs(np.diff(theta)).sum())
    assert abs(theta[-1] - theta[0]) == pytest.approx(needed, abs=0.03)
    wanted = (turned - abs(theta[-1] - theta[0])) / 10.0
    found = value_of(scores_of("path_irregularity", run))
    assert found == pytest.approx(wanted, abs=2e-4)
    total = value_of(scores_of("cumulative_heading_change", run))
    assert total == pytest.approx(turned, abs=1e-9)


def test_a_turn_all_the_way_round_needs_nothing() -> None:
    """Headings are compared on the circle: whoever turns round once looks as before."""
    run = driven(T, v=1.0, w=2.0 * math.pi / 10.0)
    assert value_of(scores_of("path_irregularity", run)) == pytest.approx(0.2 * math.pi, rel=1e-3)
