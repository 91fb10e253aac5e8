"""Three ways to turn commands into motion, against closed forms."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crowdbot.core.crowd import state as s
from crowdbot.core.sim.contacts.outline_gap import outline_gap
from crowdbot.core.sim.control.kinematic import arc, free_share
from crowdbot.core.support.ticks import TICK
from tests.core.sim.sim_worlds import Drive, alone, constant, person, rig, scenario

pytestmark = pytest.mark.slow

MODES = ("kinematic", "force", "differential_drive")
MIDDLE = "robots.robot.task.start=[25, 0, 0]"


def _mode(mode: str) -> str:
    return f"robots.robot.control={mode}"


def _forward(robot: object) -> float:
    r = robot
    return float(r.vx * math.cos(r.yaw) + r.vy * math.sin(r.yaw))  # type: ignore[attr-defined]


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("v", "w"), [(0.5, 0.0), (0.0, 1.5), (0.4, 1.0), (0.65, 3.14)])
def test_every_mode_settles_at_the_command(mode: str, v: float, w: float) -> None:
    """Ramps of 1 m/s^2 and 2 rad/s^2, one tick late; then within half a per cent."""
    track = rig(alone(MIDDLE, _mode(mode)), constant(v, w)).track(4.0, TICK)
    late = [r for t, r in track if t > 3.0]
    bound = 0.5e-2 if mode == "differential_drive" else 1e-3
    assert [_forward(r) for r in late] == pytest.approx([v] * len(late), rel=bound, abs=1e-6)
    assert [r.w for r in late] == pytest.approx([w] * len(late), rel=bound, abs=1e-6)
    for t, r in track:
        assert _forward(r) <= min(v, t) + 1e-3
        assert r.w <= min(w, 2.0 * t) * 1.001 + 1e-3
        assert r.tilt < math.radians(0.05)
    if mode != "differential_drive":  # wheels need some ticks to follow
        ramp = [(t, r) for t, r in track if t < min(v or 9.0, 0.5 * w or 9.0)]
        assert [_forward(r) for _, r in ramp] == pytest.approx(
            [max(0.0, min(v, t - TICK)) if v else 0.0 for t, _ in ramp], abs=9e-3
        )


@pytest.mark.parametrize("mode", MODES)
def test_odometry_counts_in_every_mode(mode: str) -> None:
    """The firmware's 0.035 m for wheels of 0.0352 m: 0.57 % too short."""
    drive = Drive(lambda t: (0.5, 0.2) if t < 5.0 else (0.0, 0.0))
    world = rig(alone(MIDDLE, _mode(mode)), drive).advance(6.5)
    robot, readings = world.robot(), world.memory.readings["odometry"]
    assert readings[-1].values[2] / robot.yaw == pytest.approx(0.035 / 0.0352, rel=1e-3)
    middle = readings[len(readings) // 2]
    assert middle.values[3] == pytest.approx(0.5 * 0.035 / 0.0352, rel=0.02)


@pytest.mark.parametrize("mode", MODES)
def test_a_wall_stops_every_mode(mode: str) -> None:
    """Also books one contact with it, at the speed of the approach."""
    world = rig(alone("robots.robot.task.start=[25, 4, 1.5707963267948966]", _mode(mode)),
                constant(0.4))  # fmt: skip
    track = world.track(5.0)
    assert max(r.y for _, r in track) < 4.822 + 3e-3
    assert max(r.tilt for _, r in track) < math.radians(1.0)
    assert abs(_forward(track[-1][1])) < 1e-3
    world.own.logger.walls.finish()
    (contact,) = world.memory.contacts
    assert contact["agent"] == -1
    assert contact["relative_speed"] == pytest.approx(0.4, rel=0.01)
    assert contact["t0"] == pytest.approx(0.822 / 0.4 + 0.2, abs=0.05)
    assert contact["t1"] == pytest.approx(5.0, abs=0.02)
    if mode == "kinematic":
        assert contact["impulse"] == contact["peak_force"] == 0.0
    else:  # brakes 6.3 kg from 0.4 m/s, then the wheels push on
        most = 2.0 / 0.0352
        pushed = most * (contact["t1"] - contact["t0"])
        assert contact["peak_force"] > most
        if mode == "force":
            assert contact["impulse"] == pytest.approx(6.3 * 0.4 + pushed, rel=0.05)
        else:
            assert 6.3 * 0.4 < contact["impulse"] < 6.3 * 0.4 + pushed * 1.05


@pytest.mark.parametrize("mode", ["kinematic", "force"])
def test_people_push_what_has_mass_only(mode: str) -> None:
    world = rig(scenario(MIDDLE, _mode(mode)), constant(0.0), person(26.5))
    world.advance(2.5)
    robot = world.robot()
    felt, (touch,) = s.contact_with(world.crowd())
    assert touch[s.TOUCHES] + touch[s.TOUCHING] >= 1.0
    assert felt[s.ROBOT_JX] == -felt[s.PEOPLE_JX] != 0.0
    moved = math.hypot(robot.x - 25.0, robot.y)
    assert (moved == 0.0) == (mode == "kinematic")


def test_a_force_is_no_more_than_the_wheels_could_give() -> None:
    """A slew of 100 m/s^2: 6.45 kg, rolling wheels counted, at 56.8 N take 0.057 s to 0.5 m/s.

    In the first ticks the wheels slip, and only the 6 kg of the body are moved.
    """
    quick = "robots.robot.model.max_acceleration=100 m/s^2"
    track = rig(alone(MIDDLE, _mode("force"), quick), constant(0.5)).track(0.5, TICK)
    for (_, before), (_, after) in itertools.pairwise(track):
        # The body pitches by 0.03 degrees: base_link, near the floor, swings ahead of its centre.
        assert (after.vx - before.vx) / TICK <= 2.0 / 0.0352 / 6.0 * 1.08
    reached = next(t for t, r in track if r.vx > 0.495)
    assert reached == pytest.approx(0.5 * 6.45 * 0.0352 / 2.0 + TICK, abs=2 * TICK)


def test_without_commands_the_robot_stops() -> None:
    """One command a second, a driver that waits 0.6 s for it."""
    world = rig(alone(MIDDLE, _mode("kinematic"), "rates.planner=1 Hz"), constant(0.3))
    track = dict(world.track(1.0, TICK))
    assert track[0.5].vx == pytest.approx(0.3)
    assert track[0.984375].vx == pytest.approx(0.0, abs=1e-9)


def test_a_patient_driver_goes_on() -> None:
    patient = "robots.robot.model.command_timeout=2 s"
    world = rig(alone(MIDDLE, _mode("kinematic"), "rates.planner=1 Hz", patient), constant(0.3))
    assert world.advance(3.0).robot().vx == pytest.approx(0.3)


SMALL = st.floats(-3.0, 3.0)
NO_OUTLINE = np.zeros((0, 2))


@given(x=SMALL, y=SMALL, yaw=SMALL, v=SMALL, w=SMALL, first=st.floats(0.1, 2.0))
def test_two_arcs_are_one(x: float, y: float, yaw: float, v: float, w: float, first: float) -> None:
    """Constant v and w: halves of the way add up, as small steps do."""
    whole = arc(x, y, yaw, v, w, first + 1.0)
    parts = arc(*arc(x, y, yaw, v, w, first), v, w, 1.0)
    assert parts[:2] == pytest.approx(whole[:2], abs=1e-9)
    assert math.cos(parts[2] - whole[2]) == pytest.approx(1.0)
    radius = v / w if abs(w) > 1e-6 else math.inf
    if math.isfinite(radius):  # the centre of the circle stays where it was
        centre = (x - radius * math.sin(yaw), y + radius * math.cos(yaw))
        away = math.hypot(whole[0] - centre[0], whole[1] - centre[1])
        assert away == pytest.approx(abs(radius), rel=1e-6, abs=1e-9)


@given(yaw=SMALL, way=st.floats(0.0, 0.01), turn=st.floats(-0.1, 0.1), gap=st.floats(0.0, 0.02))
def test_nobody_enters_a_wall(yaw: float, way: float, turn: float, gap: float) -> None:
    walls, pillars = np.array([[5.0, -9.0, 5.0, 9.0]]), np.array([[0.0, 3.0, 0.5]])
    x, y = 5.0 - 0.2 - gap, 0.0
    share = free_share(walls, pillars, np.zeros((0, 2)), 0.2, x, y, yaw, 0.0, way, turn)
    new_x, _, _ = arc(x, y, yaw, way * share, turn * share, 1.0)
    assert 0.0 <= share <= 1.0
    assert new_x <= 4.8 + 2e-9
    blocked = arc(x, y, yaw, way, turn, 1.0)[0] > 4.8 + 1e-8
    assert (share < 1.0) == blocked or abs(arc(x, y, yaw, way, turn, 1.0)[0] - 4.8) < 1e-7
    if blocked:
        assert new_x == pytest.approx(4.8, abs=1e-6)


def _plainly_free(
    walls: Any, pillars: Any, outline: Any, radius: float, motion: tuple[float, ...]
) -> float:
    """`free_share` with sines in each step, and the whole gap."""
    x, y, yaw, crab, way, turn = motion

    def gap_after(share: float) -> float:
        half = 0.5 * (share * turn)
        chord = share * way * (math.sin(half) / half if half != 0.0 else 1.0)
        at = x + chord * math.cos(yaw + crab + half), y + chord * math.sin(yaw + crab + half)
        return float(outline_gap(walls, pillars, outline, *at, yaw + share * turn))

    least = min(radius - 1e-9, outline_gap(walls, pillars, outline, x, y, yaw) - 1e-13)
    if gap_after(1.0) >= least:
        return 1.0
    free, blocked = 0.0, 1.0
    for _ in range(40):
        share = 0.5 * (free + blocked)
        free, blocked = (share, blocked) if gap_after(share) >= least else (free, share)
    return free


@given(
    yaw=SMALL, crab=st.sampled_from([0.0, 0.4]), way=st.floats(0.0, 0.01),
    turn=st.floats(-0.04, 0.04), gap=st.floats(-0.001, 0.01), box=st.booleans(),
    x=st.sampled_from([0.0, 17.3, -400.0]),
)  # fmt: skip
def test_the_free_share_has_the_bits_of_a_plain_search(
    yaw: float, crab: float, way: float, turn: float, gap: float, box: bool, x: float
) -> None:
    outline = np.array([[0.2, 0.1], [-0.2, 0.1], [-0.2, -0.1], [0.2, -0.1]]) if box else NO_OUTLINE
    radius = 1e-6 if box else 0.2
    walls = np.array([[x + 0.2 + gap, -9.0, x + 0.25 + gap, 9.0], [x - 9.0, 0.5, x + 9.0, 0.5]])
    place = walls, np.array([[x, -0.4, 0.1]]), outline, radius
    motion = x, 0.0, yaw, crab, way, turn
    assert free_share(*place, *motion) == _plainly_free(*place, motion)


def test_modes_see_the_same_and_repeat_bit_by_bit() -> None:
    for mode in MODES:
        runs = [
            rig(scenario(_mode(mode)), Drive(lambda t: (0.4, 0.3 * math.sin(t))),
                sensors=("odometry", "front_lidar")).advance(2.0).everything()
            for _ in range(2)
        ]  # fmt: skip
        assert runs[0] == runs[1]
