"""People followed by their legs in the scans of the challenge's two lidars."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.points import LidarPoints
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sensing.tracking.people_tracker import PeopleTracker, Tracks
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState
from crowdbot.core.types.sensor import Reading
from tests.plugins.planners.world import lidars

Array = NDArray[np.float64]
RATE, ORIGIN = 16.0, Pose(0.0, 0.0, 0.0)
ROOM = np.array([[-9.0, -4, 9, -4], [9, -4, 9, 4], [9, 4, -9, 4], [-9, 4, -9, -4]])


class Street:
    """People (M, 4) who walk straight on, and a robot that may turn."""

    def __init__(self, people: ArrayLike, walls: Array = ROOM, radius: float = 0.33) -> None:
        self.people = np.array(people, np.float64).reshape(-1, 4)
        count = len(self.people)
        self.scene = Scene(walls, [0.0, 2.5], np.full(count, radius), 1.7)
        self.sensors = lidars()
        self.points = LidarPoints({n: s.info() for n, s in self.sensors.items()})
        self.walked = np.zeros(count)
        self.step = 0

    def scan(self, pose: Pose = ORIGIN) -> tuple[float, Array]:
        """Advance by a step and return the time and the points of the scan."""
        t = self.step / RATE
        speed = np.hypot(self.people[:, 2], self.people[:, 3])
        if self.step:
            self.people[:, :2] += self.people[:, 2:] / RATE
            self.walked += speed / RATE
        way = np.where(speed[:, None] > 0.0, self.people[:, 2:], (1.0, 0.0))
        way /= np.hypot(*way.T)[:, None]
        state = RobotState(*pose, 0.0, 0.0, 0.0, 0.0, 0.0102, 0.0, 0.0)
        self.scene.update(state, self.people, np.ones(len(speed), np.bool_), way, self.walked)
        readings = {
            n: Reading(t, s.read(self.scene, pose, t, sensor_rng(0, "r", n, self.step)))
            for n, s in self.sensors.items()
        }
        self.step += 1
        return t, self.points(readings, t, (0.0, 0.0))


def follow(street: Street, seconds: float, turn: float = 0.0) -> list[Tracks]:
    tracker, found = PeopleTracker(), []
    for step in range(int(seconds * RATE)):
        pose = Pose(0.0, 0.0, math.remainder(turn * step / RATE, 2.0 * math.pi))
        t, points = street.scan(pose)
        found.append(tracker.update(t, pose, points))
    return found


@pytest.mark.parametrize("radius", [0.16, 0.33])
@pytest.mark.parametrize("turn", [0.0, 1.0])
def test_a_walker_is_followed_at_its_velocity(radius: float, turn: float) -> None:
    street = Street([[4.0, 1.5, -1.2, -0.1]], radius=radius)
    found = follow(street, 3.0, turn)
    assert {len(tracks.id) for tracks in found[8:]} == {1}
    assert len({int(tracks.id[0]) for tracks in found[8:]}) == 1
    last = found[-1]
    assert last.position[0] == pytest.approx(street.people[0, :2], abs=0.12)
    assert last.velocity[0] == pytest.approx([-1.2, -0.1], abs=0.25)


def test_a_crowd_is_seen_whole() -> None:
    """0.4 people per m²: nearly everyone within 3 m, each about once."""
    rng = np.random.default_rng(3)
    places: list[tuple[float, float]] = []
    while len(places) < 45:
        at = tuple(rng.uniform((-8.0, -3.6), (8.0, 3.6)))
        if math.hypot(*at) > 1.0 and all(math.dist(at, p) > 0.6 for p in places):
            places.append(at)
    way = np.where(np.arange(45) % 2, 0.8, -0.8)
    street = Street(np.column_stack([places, way, np.zeros(45)]), radius=0.16)
    tracker, met, near, false, errors = PeopleTracker(), 0, 0, 0, []
    for step in range(48):
        t, points = street.scan()
        tracks = tracker.update(t, Pose(0.0, 0.0, 0.0), points)
        if step < 16:
            continue
        gap = np.hypot(*(tracks.position[:, None] - street.people[None, :, :2]).T)
        close = np.hypot(*street.people[:, :2].T) < 3.0
        near += int(close.sum())
        met += int((gap[close].min(axis=1) < 0.3).sum())
        nobody = gap.min(axis=0) > 0.5
        false += int((nobody & (np.hypot(*tracks.position.T) < 3.0)).sum())
        best = gap[close].argmin(axis=1)
        errors.append(tracks.velocity[best] - street.people[close, 2:])
    assert met > 0.97 * near
    assert false < 0.02 * near
    assert math.sqrt(np.mean(np.concatenate(errors) ** 2) * 2.0) < 0.25


def test_who_is_hidden_for_a_second_keeps_the_number() -> None:
    """A person walks behind another one who stands near the robot."""
    found = follow(Street([[1.4, 0.0, 0.0, 0.0], [3.0, 1.6, 0.0, -0.9]], radius=0.16), 4.0)
    walkers = [tracks.id[np.abs(tracks.velocity[:, 1]) > 0.5] for tracks in found[8:]]
    assert len({int(n) for numbers in walkers for n in numbers}) == 1
    assert max(float(tracks.unseen.max(initial=0.0)) for tracks in found) > 0.1


def test_walls_and_pillars_are_nobody() -> None:
    pillar = [[3.0 + 0.3 * math.cos(a), 1.0 + 0.3 * math.sin(a)] for a in np.linspace(0, 6.3, 13)]
    sides = np.array([[*a, *b] for a, b in pairwise(pillar)])
    found = follow(Street(np.zeros((0, 4)), np.concatenate([ROOM, sides])), 4.0, turn=0.7)
    assert sum(len(tracks.id) for tracks in found) == 0


def test_reset_forgets() -> None:
    street, tracker = Street([[3.0, 0.0, -1.0, 0.0]]), PeopleTracker()
    for _ in range(16):
        tracker.update(*street_scan(street))
    tracker.reset()
    assert len(tracker.update(*street_scan(street)).id) == 0


def street_scan(street: Street) -> tuple[float, Pose, Array]:
    t, points = street.scan()
    return t, Pose(0.0, 0.0, 0.0), points


def test_rows_of_recordings() -> None:
    tracks = follow(Street([[3.0, 0.5, -1.0, 0.0]]), 1.0)[-1]
    assert tracks.rows.shape == (1, 5)
    assert tracks.rows[0, 1:3] == pytest.approx(tracks.position[0])
