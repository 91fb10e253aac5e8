"""The place beside a person: hand-computed poses, and agreement of place and window."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.geometry.stance import PersonCircle, in_place, off, place_beside, together
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.person_task import PersonTask, PersonTaskKind
from crowdbot.core.types.robot import RobotBody

DISC = Footprint(np.zeros((0, 2)), 0.25)
BODY = RobotBody(
    drive="holonomic", radius=0.25, footprint=None, front=0.25, back=0.25, half_width=0.25
)
KINDS = get_args(PersonTaskKind)


def task(kind: PersonTaskKind, **changes: object) -> PersonTask:
    given = {"distance": 1.0, "tolerance": 0.3, "angle": math.radians(45.0), "radius": 0.25}
    return PersonTask(kind=kind, **{**given, **changes})  # type: ignore[arg-type]


def person(x: float, y: float, heading: float) -> PersonCircle:
    return PersonCircle(np.array([x]), np.array([y]), np.array([heading]), np.array([0.25]))


@pytest.mark.parametrize(
    ("kind", "x", "y", "yaw"),
    [
        ("approach", 6.5, 2.0, math.pi),  # ahead of one who faces east, and turned back to it
        ("follow", 3.5, 2.0, 0.0),
        ("accompany", 5.0, 0.5, 0.0),  # on the side where the robot is
        ("lead", 6.5, 2.0, 0.0),
    ],
)
def test_the_place_is_where_it_was_worked_out(
    kind: PersonTaskKind, x: float, y: float, yaw: float
) -> None:
    found = place_beside(task(kind), BODY, 5.0, 2.0, 0.0, Pose(5.0, -3.0, 1.0))
    assert found[:2] == pytest.approx((x, y))
    assert math.cos(found.yaw - yaw) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("heading", [0.0, 1.2, -2.5, math.nan])
def test_who_stands_at_the_place_is_in_place(kind: PersonTaskKind, heading: float) -> None:
    wanted = place_beside(task(kind), BODY, 5.0, 2.0, heading, Pose(0.3, 1.0, 0.4))
    x, y, yaw = (np.array([v]) for v in wanted)
    found = off(DISC, x, y, yaw, person(5.0, 2.0, heading))
    assert found.gap[0] == pytest.approx(1.0)
    assert in_place(task(kind), found)[0]


@pytest.mark.parametrize("kind", ["approach", "follow", "accompany"])
def test_neither_too_near_nor_too_far_nor_turned_away(kind: PersonTaskKind) -> None:
    wanted = place_beside(task(kind), BODY, 0.0, 0.0, 0.7, Pose(2.0, 0.0, 0.0))
    out = np.array([wanted.x, wanted.y]) / math.hypot(wanted.x, wanted.y)
    for step, turn, fits in [(0.29, 0, True), (0.31, 0, False), (-0.31, 0, False), (0, 1, False)]:
        x, y = (np.array([v]) for v in np.array([wanted.x, wanted.y]) + step * out)
        yaw = np.array([wanted.yaw + turn])
        assert in_place(task(kind), off(DISC, x, y, yaw, person(0.0, 0.0, 0.7)))[0] == fits


def test_behind_is_not_in_front() -> None:
    behind = off(DISC, np.array([-1.5]), np.array([0.0]), np.array([0.0]), person(0.0, 0.0, 0.0))
    assert not in_place(task("approach"), behind)[0]
    assert in_place(task("follow"), behind)[0]
    assert abs(behind.around[0]) == pytest.approx(math.pi)


def test_a_side_that_is_asked_for() -> None:
    left = off(DISC, np.array([0.0]), np.array([1.5]), np.array([0.0]), person(0.0, 0.0, 0.0))
    assert in_place(task("accompany", side="left"), left)[0]
    assert in_place(task("accompany"), left)[0]
    assert not in_place(task("accompany", side="right"), left)[0]


def test_a_group_is_a_circle_with_the_front_that_its_members_share() -> None:
    x, y = np.array([[0.0, 0.0]]), np.array([[-0.5, 0.5]])
    facing = np.radians([[45.0, -45.0]])
    found = together(x, y, facing, np.array([0.25, 0.25]))
    assert (found.x[0], found.y[0], found.radius[0]) == pytest.approx((0.0, 0.0, 0.75))
    assert found.heading[0] == pytest.approx(0.0)
    talking = together(x, y, np.radians([[90.0, -90.0]]), np.array([0.25, 0.25]))
    assert np.isnan(talking.heading[0])
    gone = together(x * np.nan, y * np.nan, facing * np.nan, np.array([0.25, 0.25]))
    assert np.isnan(gone.x[0])
    assert not in_place(task("approach"), off(DISC, x[:, 0], y[:, 0], x[:, 0], gone))[0]
