"""Shared control: what becomes of the user's command, with the way free and with people in it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.planning.selected_sensors import select_sensors
from crowdbot.core.registry.registry import discover
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError
from crowdbot.plugin import Command, Observation, Planner, Pose, Reading, SensorInfo
from crowdbot.plugins.planners.probabilistic import joint_build as joint
from crowdbot.plugins.planners.shared.stopping_build import arc_gap_moving
from crowdbot.testing.drive import LIMITS, Course

OURS = discover(allow=())
BEAMS = np.linspace(-math.pi, math.pi, 721)[:-1]
LIDAR = SensorInfo(category="lidar", frame="lidar", mount=(0, 0, 0, 0), rate=16.0, shape=(720,),
                   ros_type="sensor_msgs/msg/LaserScan", angles=BEAMS, range_min=0.05,
                   range_max=10.0)  # fmt: skip
STICK = replace(LIDAR, category="joystick", shape=(2,), angles=None)
SENSORS = {"lidar": LIDAR, "stick": STICK}
#: x, y, radius of pillars.
FREE: tuple[tuple[float, float, float], ...] = ()
BEFORE = ((1.0, 0.0, 0.25),)


def scan(pillars: tuple[tuple[float, float, float], ...]) -> NDArray[np.float64]:
    """Ranges to pillars around a lidar at the origin."""
    ranges = np.full(len(BEAMS), np.inf)
    for x, y, r in pillars:
        along = x * np.cos(BEAMS) + y * np.sin(BEAMS)
        across = x * x + y * y - along**2
        hit = (along > 0) & (across < r * r)
        ranges[hit] = np.minimum(ranges[hit], along[hit] - np.sqrt(r * r - across[hit]))
    return ranges


def drive(
    planner: Planner,
    user: tuple[float, float],
    pillars: tuple[tuple[float, float, float], ...] = FREE,
    twist: tuple[float, float] = (0.0, 0.0),
    goal: tuple[float, float] = (7.0, 0.0),
    steps: int = 3,
) -> tuple[Command, dict[str, float]]:
    """The command after some steps of a robot at the origin, and the signals of the last one."""
    planner.reset(Course().task, LIMITS, SENSORS, 0)
    signals: dict[str, float] = {}
    command = Command(0.0, 0.0)
    for k in range(steps):
        t = k / 16
        readings = {
            "lidar": Reading(t, scan(pillars)),
            "stick": Reading(t, np.array(user, np.float64)),
        }
        command = planner.step(
            Observation(
                t=t,
                pose=Pose(0, 0, 0),
                twist=twist,
                goal=goal,
                goal_zone=np.zeros((4, 2)),
                readings=readings,
                log=lambda name, value: signals.__setitem__(name, value),
            )
        )
    return command, signals


def made(kind: str, **settings: Any) -> Planner:
    return resolve_planner(kind, OURS, [f"{k}={v}" for k, v in settings.items()]).build()


def test_pass_through_is_the_user_within_the_limits() -> None:
    assert drive(made("pass_through"), (0.3, -0.2), BEFORE)[0] == Command(0.3, -0.2)
    assert drive(made("pass_through"), (9.0, -9.0))[0] == Command(LIMITS.v_max, -LIMITS.w_max)


def test_before_the_first_reading_the_robot_stands() -> None:
    planner = made("pass_through")
    planner.reset(Course().task, LIMITS, SENSORS, 0)
    obs = Observation(
        t=0, pose=Pose(0, 0, 0), twist=(0, 0), goal=(1, 0), goal_zone=np.zeros((4, 2))
    )
    assert planner.step(obs) == Command(0.0, 0.0)


def test_a_free_way_is_the_users_own() -> None:
    for kind in ("safety_stop", "linear_blending"):
        assert drive(made(kind), (0.5, 0.3))[0] == Command(0.5, 0.3)
    command, _ = drive(made("probabilistic", autonomy="goal_seek"), (0.6, 0.0), twist=(0.6, 0.0))
    assert command == pytest.approx(Command(0.6, 0.0), abs=0.06)


def test_the_safety_stop_brakes_and_lets_the_user_turn_away() -> None:
    near = ((0.6, 0.0, 0.25),)  # 0.17 m before the disc of the robot
    command, signals = drive(made("safety_stop"), (0.6, 0.0), near)
    assert 0.0 <= command.v < 0.35
    assert signals["safety_stop/intervenes"] == 1.0
    turned, _ = drive(made("safety_stop"), (0.0, 0.8), near)
    assert turned == Command(0.0, 0.8)
    away, signals = drive(made("safety_stop"), (-0.5, 0.0), near)
    assert away == Command(-0.5, 0.0)
    assert signals["safety_stop/intervenes"] == 0.0


def test_the_other_half_takes_over_where_the_user_is_unsafe() -> None:
    planner = made("safety_stop", autonomy="goal_seek")
    near = ((0.45, 0.0, 0.2),)
    command, _ = drive(planner, (0.6, 0.0), near, goal=(0.0, 7.0))
    assert command.v == 0.0
    assert command.w > 1.0  # goal_seek turns to the goal on the left


def test_rds_stays_near_to_the_user_and_lets_nothing_be_touched() -> None:
    planner = made("rds", wish="user")
    free, signals = drive(planner, (0.5, 0.3))
    assert free == pytest.approx(Command(0.5, 0.3))
    assert signals["rds/change"] == pytest.approx(0.0)
    near, signals = drive(planner, (0.6, 0.0), BEFORE)
    assert 0.0 <= near.v < 0.4
    assert signals["rds/change"] > 0.1
    assert drive(planner, (0.0, 0.0), BEFORE)[0] == Command(0.0, 0.0)  # it goes nowhere by itself
    with pytest.raises(InputError, match="joystick"):
        planner.reset(Course().task, LIMITS, {"lidar": LIDAR}, 0)


@pytest.mark.parametrize(("share", "w"), [(0.0, 0.4), (0.25, 0.3), (1.0, 0.0)])
def test_a_fixed_share_is_the_weighted_mean(share: float, w: float) -> None:
    planner = made("linear_blending", arbitration="fixed", share=share, autonomy="goal_seek")
    command, signals = drive(planner, (LIMITS.v_max, 0.4))
    assert command == pytest.approx(Command(LIMITS.v_max, w))
    assert signals["linear_blending/share"] == share


def test_the_planners_share_rises_towards_the_goal() -> None:
    planner = made("linear_blending", arbitration="goal", least=0.1, most=0.7, distance=3.0,
                   full_distance=1.0, autonomy="goal_seek")  # fmt: skip
    shares = [
        drive(planner, (0.5, 0.0), goal=(x, 0.0))[1]["linear_blending/share"]
        for x in (5.0, 2.0, 0.5)
    ]
    assert shares == pytest.approx([0.1, 0.4, 0.7])


def test_the_planners_share_rises_where_the_users_way_is_blocked() -> None:
    planner = made("linear_blending", autonomy="goal_seek")
    ahead, aside = (
        drive(planner, user, BEFORE)[1]["linear_blending/share"]
        for user in ((0.6, 0.0), (-0.6, 0.0))
    )
    assert ahead > 0.7
    assert aside < ahead - 0.1


def test_the_joint_density_weighs_user_robot_and_crowd() -> None:
    """A pillar half in the user's way is passed on its free side, though the planner is blind."""
    for side in (1.0, -1.0):
        planner = made("probabilistic", autonomy="goal_seek")
        command, _ = drive(planner, (0.6, 0.0), ((1.2, -0.25 * side, 0.2),), twist=(0.5, 0.0))
        assert 0.2 < command.v < 0.6
        assert side * command.w > 0.2


#: Horizon, agreeability, spreads of user, planner and people, avoidance, safety, front, limits,
#: standing.
_JOINT = np.array([2.0, 0.3, 0.5, 0.8, 0.15, 0.9999, 0.3, 0.5, 1.0, 2.0, 1.0])
_DISC = np.array([[0.0, 0.0, 0.35]])
_ON = (1.0, 0.0, 0.0)


def _likely(
    ways: list[tuple[float, ...]],
    person: tuple[float, ...],
    horizon: float = 2.0,
    spread: float = 0.15,
) -> Array:
    """The log density of each way of a robot that drives on at 1 m/s, as its user wants."""
    p = _JOINT.copy()
    p[[joint.HORIZON, joint.PEOPLE_SPREAD]] = horizon, spread
    on = np.array(_ON)
    return joint.log_densities(np.array(ways), on, on, np.array([person]), _DISC, on, p)


def test_a_way_through_a_person_is_not_the_more_likely_the_faster_it_is() -> None:
    """The person stays where it is."""
    person = (2.0, 0.0, 0.0, 0.0, 0.25)
    through, slow = _likely([_ON, (0.2, 0.0, 0.0)], person, horizon=4.0, spread=0.01)
    assert slow > through + 10.0


@pytest.mark.parametrize("far", [2.5, 3.0, 3.5])
def test_a_user_who_drives_into_an_oncoming_person_is_led_past(far: float) -> None:
    """User and planner want to go straight on; the spread of the person's way hides no contact."""
    person = (far, 0.05, -1.2, 0.0, 0.25)
    straight, beside = _likely([_ON, (0.9, -0.75, 0.0)], person)
    assert beside > straight + 5.0
    assert abs(_likely([_ON], (far, 4.0, -1.2, 0.0, 0.25))[0]) < 1e-3  # not in the way


def test_a_way_is_likely_if_the_person_can_step_aside_and_not_if_there_is_no_time() -> None:
    """Two people in the way, one to be reached in 1.4 s, the other in half a second."""
    far, close = ((x, 0.2, 0.0, 0.0, 0.25) for x in (2.0, 1.1))
    assert _likely([_ON], far)[0] > -8.0
    assert _likely([_ON], close)[0] < -25.0
    assert _likely([_ON], far, spread=0.01)[0] < -25.0  # one who does not step aside


def test_no_one_is_driven_ahead_who_does_not_ask_for_it() -> None:
    """A user who stands is not moved away from what is close behind the chair."""
    planner = made("probabilistic", autonomy="stand_still")
    command, _ = drive(planner, (0.0, 0.0), ((-0.55, 0.0, 0.1), (-0.5, 0.2, 0.1)))
    assert command.v == 0.0


def test_a_planner_that_agrees_with_the_user_has_the_last_word() -> None:
    """With a planner of little doubt the robot follows it, with one of much doubt the user."""
    doubts = {
        spread: drive(made("probabilistic", autonomy="goal_seek", robot_spread=spread,
                           user_spread=0.4), (0.6, 0.8), twist=(0.6, 0.4))[0].w
        for spread in (0.02, 5.0)
    }  # fmt: skip
    assert doubts[0.02] < 0.2 < 0.6 < doubts[5.0]


def test_the_most_likely_way_is_no_flight_that_no_one_asks_for() -> None:
    """A wall of people before it: it waits; it goes back if the user does."""
    near = tuple((0.45, 0.45 * y, 0.25) for y in (-1.0, 0.0, 1.0))
    planner = made("probabilistic", autonomy="goal_seek")
    assert drive(planner, (0.6, 0.0), near)[0].v >= 0.0
    assert drive(planner, (-0.5, 0.0), near)[0].v < -0.2


def test_the_gap_on_an_arc_counts_people_who_come_and_brakes() -> None:
    robot = np.array([[0.0, 0.0, 0.2]])

    def gap(bodies: Array, v: float, brake: float = 1.0) -> float:
        return arc_gap_moving(bodies, robot, v, 0.0, 0.2, brake)

    still, coming = np.array([[2.0, 0, 0, 0, 0.3]]), np.array([[2.0, 0, -1.0, 0, 0.3]])
    assert gap(still, 0.0) == pytest.approx(1.5)
    assert gap(still, 1.0) == pytest.approx(1.5 - 0.2 - 0.5, abs=0.06)
    assert gap(still, 1.0, math.inf) == pytest.approx(1.3, abs=0.01)
    assert gap(coming, 1.0) == pytest.approx(1.5 - 0.7 - 1.2, abs=0.12)
    assert gap(np.zeros((0, 5)), 1.0) == math.inf


def test_a_wrong_ramp_and_a_robot_without_a_stick_are_refused() -> None:
    with pytest.raises(InputError, match=r"full_distance \(3 m\) is less than distance \(2 m\)"):
        made("linear_blending", full_distance=3.0)
    needs = resolve_planner("linear_blending", OURS).needs
    with pytest.raises(InputError, match="needs 'joystick'; the robot's sensors: lidar"):
        select_sensors(needs, {"lidar": LIDAR}, "linear_blending")
