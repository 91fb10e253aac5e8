"""Tracks of people against the truth: shares, switches and errors of made-up tracks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.trajectories.tracking_quality import tracking_quality
from crowdbot.core.trajectories.trajectories import Trajectories

Array = NDArray[np.float64]
T = np.arange(0.0, 11.0, 0.125)
PEOPLE = np.array([[2.0, 1.0], [4.5, 0.0], [0.0, -2.0]])


def truth(yaw: float = 0.6) -> Trajectories:
    """A robot that stands turned at (1, 2), and three people who walk north with it in view."""
    count = len(T)
    x, y = (np.tile(PEOPLE[:, k], (count, 1)) + (1.0, 2.0)[k] for k in (0, 1))
    return Trajectories.from_arrays(
        t=T, robot_x=np.full(count, 1.0), robot_y=np.full(count, 2.0),
        robot_theta=np.full(count, yaw), robot_v=np.zeros(count), robot_w=np.zeros(count),
        robot_radius=0.2, robot_mass=6.0, agent_id=[7, 8, 9], agent_x=x, agent_y=y,
        agent_vx=np.zeros((count, 3)), agent_vy=np.full((count, 3), 0.1),
        agent_radius=np.full(3, 0.2), agent_mass=np.full(3, 75.0),
    )  # fmt: skip


def rows(
    numbers: list[float], places: NDArray[np.float64], yaw: float = 0.6
) -> NDArray[np.float64]:
    """Return rows of tracks at places around the robot in world axes, in its base frame."""
    c, s = math.cos(yaw), math.sin(yaw)
    back = np.array([[c, -s], [s, c]])
    going = np.tile([0.0, 0.1], (len(places), 1)) @ back
    return np.column_stack([numbers, places @ back, going])


def test_perfect_tracks_have_no_errors() -> None:
    drawn = [(float(t), rows([1, 2, 3], PEOPLE)) for t in T]
    near, far = tracking_quality(truth(), drawn, [3.0, 6.0])
    instants = int((T >= 1.0).sum())
    assert (near.people, far.people) == (2 * instants, 3 * instants)
    for one in (near, far):
        assert (one.recall, one.false, one.switches) == (1.0, 0.0, 0.0)
        assert one.position_error == pytest.approx(0.0, abs=1e-9)
        assert one.velocity_error == pytest.approx(0.0, abs=1e-9)


def test_missing_false_and_shifted_tracks() -> None:
    places = np.array([[1.7, 1.0], [-1.0, 1.0]])  # 0.3 m off, and no person
    drawn = [(float(t), rows([1, 2], places)) for t in T]
    (near,) = tracking_quality(truth(), drawn, [3.0])
    assert near.recall == pytest.approx(0.5)
    assert near.false == pytest.approx(0.5)
    assert near.position_error == pytest.approx(0.3)


def test_numbers_that_change_are_switches() -> None:
    drawn = [(float(t), rows([k // 40, 2, 3], PEOPLE)) for k, t in enumerate(T)]
    (near,) = tracking_quality(truth(), drawn, [3.0])
    minutes = near.people * 0.125 / 60.0
    assert near.switches == pytest.approx(2.0 / minutes)


def test_without_tracks_nobody_is_found() -> None:
    drawn = [(float(t), np.zeros((0, 5))) for t in T]
    (near,) = tracking_quality(truth(), drawn, [3.0])
    assert (near.recall, near.false, near.position_error) == (0.0, None, None)
