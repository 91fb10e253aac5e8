"""What other evaluators get wrong: one test for each row of developers/defects_of_evaluators.md."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import crowdbot
from tests.paths import ROOT

Array = NDArray[np.float64]
DEFECTS = ROOT / "docs/developers/defects_of_evaluators.md"


def robot(t: Array, x: Any, y: Any = 0.0, theta: Any = 0.0, **more: Any) -> dict[str, Any]:
    """A robot of 0.18 m; v and w are what positions and headings imply."""
    x, y, theta = (np.zeros(len(t)) + part for part in (x, y, theta))
    speed = np.hypot(np.gradient(x, t), np.gradient(y, t))
    return {
        "t": t,
        "robot_x": x,
        "robot_y": y,
        "robot_theta": theta,
        "robot_v": more.pop("v", speed) + 0.0 * t,
        "robot_w": np.gradient(theta, t),
        "robot_radius": 0.18,
        "robot_mass": 6.3,
        "robot_goal_time": more.pop("goal_time", float(t[-1])),
        **more,
    }


def people(x: Any, y: Any, **more: Any) -> dict[str, Any]:
    """People of 0.25 m; x, y are (N, M)."""
    return {"agent_x": x, "agent_y": y, "agent_radius": 0.25, "agent_mass": 70.0, **more}


def run(**given: Any) -> crowdbot.Trajectories:
    return crowdbot.Trajectories.from_arrays(**given)


def one(
    metric: str, variant: str, crowded: Any, robot_alone: Any = None, **given: Any
) -> crowdbot.Score:
    found = crowdbot.score(crowded, robot_alone, metrics=metric, **given)
    return found.find(metric, variant)


def grid(rate: float, end: float = 10.0) -> Array:
    return np.linspace(0.0, end, round(end * rate) + 1, dtype=np.float64)


# ---------------------------------------------------------------------- the path
def test_turning_on_the_spot_is_no_path() -> None:
    t = grid(10)
    straight = run(**robot(t, 0.5 * t))
    pirouette = run(**robot(t, 0.5 * t, theta=3.0 * t))
    for variant in ("literal", "corrected"):
        assert one("relative_path_length", variant, pirouette, straight).value == 1.0


@pytest.mark.parametrize("speed", [12.0, 5000.0])
def test_a_teleport_adds_no_length(speed: float) -> None:
    t = grid(10)
    far = 0.5 * t + np.where(t > 5.0, 0.1 * speed, 0.0)
    alone, jumped = run(**robot(t, 0.5 * t)), run(**robot(t, far, v=0.5))
    found = one("relative_path_length", "corrected", jumped, alone)
    assert found.value == pytest.approx(5.0 / 4.95)


def test_a_detour_lowers_relative_path_length() -> None:
    t = grid(10)
    detour = run(**robot(t, 0.5 * t, np.minimum(t, 10.0 - t)))
    value = one("relative_path_length", "corrected", detour, run(**robot(t, 0.5 * t))).value
    assert value == pytest.approx(0.5 / math.hypot(0.5, 1.0))


# ------------------------------------------------------------------------- sampling
def test_jerk_does_not_grow_with_the_rate() -> None:
    def drive(rate: float) -> crowdbot.Trajectories:
        t = grid(rate)
        v = 0.5 - 0.5 * np.cos(2 * np.pi * t / 10.0)
        x = 0.5 * t - 0.5 * np.sin(2 * np.pi * t / 10.0) * 10.0 / (2 * np.pi)
        return run(**robot(t, x, v=v))

    coarse, fine = drive(16.0), drive(64.0)
    # total variation of v' over one period: four times its amplitude
    for sampled in (coarse, fine):
        found = one("relative_jerk", "linear", sampled, sampled)
        assert found.extras["crowded"] == pytest.approx(4 * 0.5 * 2 * np.pi / 10.0, rel=0.05)
    assert one("relative_jerk", "corrected", fine, coarse).reason == "sampling_mismatch"


@pytest.mark.parametrize("rate", [4.0, 16.0, 160.0])
def test_one_contact_is_one_collision_at_any_rate(rate: float) -> None:
    t = grid(rate)
    head_on = run(**robot(t, t), **people(10.0 - t[:, None], 0.0 * t[:, None]))
    assert one("collision_count", "corrected", head_on).value == 1
    energy = 0.5 * 6.3 * 70.0 / 76.3 * 4.0
    assert one("collision_severity", "corrected", head_on).value == pytest.approx(energy)


def test_a_contact_between_samples_counts() -> None:
    t = grid(2)
    passing = -11.25 + 5.0 * t[:, None]  # 1.25 m before the robot, then 1.25 m behind it
    standing = run(**robot(t, 0.0), **people(passing, 0.0 * passing))
    assert np.abs(passing).min() > 0.43
    assert one("collision_count", "corrected", standing).value == 1
    assert one("collision_count", "literal", standing).value == 0


def test_proximity_does_not_grow_with_the_rate() -> None:
    def beside(rate: float) -> crowdbot.Trajectories:
        t = grid(rate)
        return run(**robot(t, t), **people(t[:, None], 2.0 + 0.0 * t[:, None]))

    assert one("proximity", "corrected", beside(10)).value == pytest.approx(0.5)
    assert one("proximity", "corrected", beside(20)).value == pytest.approx(0.5)
    assert one("proximity", "literal", beside(10)).value == pytest.approx(50.5)


# ---------------------------------------------------------------- missing and failed
def test_unfinished_trips_are_not_dropped() -> None:
    def crowd(t1: list[float], reached: list[bool]) -> crowdbot.Trajectories:
        still = np.zeros((2, 4))
        trips = {"trip_agent": range(4), "trip_t0": [0.0] * 4, "trip_t1": t1}
        return run(t=[0.0, 14.0], **people(still, still), **trips, trip_reached=reached)

    alone = crowd([6.0, 8.0, 10.0, 14.0], [True] * 4)
    with_robot = crowd([6.0, 8.0, 10.0, 14.0], [True, False, True, True])
    found = one("effect_on_time", "corrected", with_robot, crowd_alone=alone)
    assert found.value == pytest.approx(9.5 / 10.5)


def test_a_run_that_did_not_arrive_has_no_time() -> None:
    t = grid(2)
    alone, lost = run(**robot(t, t)), run(**robot(t, t, goal_time=None), robot_goal=(9.0, 0.0))
    found = one("relative_time_to_goal", "corrected", lost, alone)
    assert (found.value, found.status, found.upper) == (None, "censored", 1.0)
    assert one("success", "corrected", lost).value == 0.0


def test_missing_data_has_a_reason_and_no_number() -> None:
    nobody = run(t=[0.0])
    for s in crowdbot.score(nobody, nobody, nobody):
        assert (s.value is None) == bool(s.reason), s
        numbers = [s.value, s.lower, s.upper, *s.extras.values()]
        assert all(math.isfinite(n) for n in numbers if n is not None)


def test_nothing_after_the_arrival_counts() -> None:
    t = grid(10)
    late = people(10.0 - t[:, None], 0.0 * t[:, None])
    arrived = run(**robot(t, t, goal_time=4.0), **late)
    assert one("collision_count", "corrected", arrived).value == 0
    assert one("collision_count", "literal", arrived).value == 0
    assert one("min_clearance", "corrected", arrived).value == pytest.approx(2.0 - 0.43)


# ------------------------------------------------------------------------- angles
def commands(v: float, w: float, v_sc: float, w_sc: float) -> crowdbot.Commands:
    return crowdbot.Commands.from_arrays(
        t=[0.0, 1.0], v_user=[v] * 2, w_user=[w] * 2, v_sc=[v_sc] * 2, w_sc=[w_sc] * 2,
        v_max=1.0, w_max=1.0, t_end=2.0,
    )  # fmt: skip


def test_agreement_wraps_angles() -> None:
    back_left, back_right = (-0.1, -1.0), (0.1, -1.0)  # just above and below pi
    found = one("agreement", "corrected", None, commands=commands(*back_left, *back_right))
    assert found.value == pytest.approx(1.0 - 2 * math.atan2(0.1, 1.0) / math.pi)


def test_agreement_tells_driving_from_turning() -> None:
    found = one("agreement", "corrected", None, commands=commands(1.0, 0.0, 0.0, 1.0))
    assert found.value == pytest.approx(0.5)


def test_headings_wrap() -> None:
    t = grid(10, 20.0)
    turn = 0.2 * t[:, None] + np.array([0.0, 3.0])  # both pass pi
    velocity = {"agent_vx": np.cos(turn), "agent_vy": np.sin(turn)}
    walkers = people(5 * np.sin(turn), -5 * np.cos(turn), **velocity)
    wrapped = np.mod(0.4 * t + math.pi, 2 * math.pi) - math.pi
    turning = run(**{**robot(t, 0.0, theta=wrapped), "robot_w": 0.4 + 0 * t}, **walkers)
    assert one("heading_similarity", "corrected", turning).value == pytest.approx(2.0, rel=1e-3)
    change = one("cumulative_heading_change", "corrected", turning)
    assert change.value == pytest.approx(8.0)


def test_entropy_does_not_see_the_sign() -> None:
    rng = np.random.default_rng(1)
    t = 0.15 * np.arange(400)
    angle = np.pi / 2 + np.abs(rng.normal(0.0, 0.05, 400))  # errors are not symmetric

    def drive(mirror: int) -> crowdbot.Commands:
        v, w = np.sin(angle), mirror * np.cos(angle)
        return crowdbot.Commands.from_arrays(
            t=t, v_user=v, w_user=w, v_sc=v, w_sc=w, v_max=1.0, w_max=1.0
        )

    def drive_both(mirror: int) -> crowdbot.Score:
        given = {"commands": drive(mirror), "commands_baseline": drive(mirror)}
        return one("user_input_entropy", "corrected", None, **given)

    left, right = drive_both(1), drive_both(-1)
    assert left.value is not None
    assert left.value == pytest.approx(right.value)
    assert left.extras["alpha"] == pytest.approx(right.extras["alpha"])


# -------------------------------------------------------------------------- people
def test_speed_does_not_telescope() -> None:
    t = grid(10)

    def crowd(speed: float) -> crowdbot.Trajectories:
        return run(t=t, **people(speed * t[:, None], 0.0 * t[:, None]))

    for variant in ("literal", "corrected"):
        found = one("effect_on_velocity", variant, crowd(0.8), crowd_alone=crowd(1.0))
        assert found.value == pytest.approx(1.25)


def test_normalised_proximity_sees_a_spread() -> None:
    t = grid(2)
    uneven = people(np.tile([1.0, -3.0], (len(t), 1)), np.zeros((len(t), 2)))
    for variant in ("literal", "corrected"):
        found = one("normalized_proximity", variant, run(**robot(t, 0.0), **uneven))
        assert found.value == pytest.approx(0.5)


def test_clearance_subtracts_both_radii() -> None:
    t = grid(2)
    beside = run(**robot(t, t), **people(t[:, None], 0.8 + 0.0 * t[:, None]))
    assert one("min_clearance", "corrected", beside).value == pytest.approx(0.8 - 0.43)
    assert one("intimate_time_fraction", "corrected", beside).value == 1.0


# ------------------------------------------------------------------------ the page
def test_every_defect_of_the_page_is_guarded() -> None:
    named = set(re.findall(r"`(test_\w+)`", DEFECTS.read_text(encoding="utf-8")))
    here = {name for name in globals() if name.startswith("test_")}
    assert named == here - {"test_every_defect_of_the_page_is_guarded"}
