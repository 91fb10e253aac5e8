"""Rehearsal: the first of several plans that has no trouble with the people foreseen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from crowdbot.plugin import Array, Pose, Truth
from crowdbot.plugins.planners.oracle.rehearsal_build import Rehearsal, TriedPath
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP

ROBOT = np.array([[0.0, 0.0, 0.2]])
HERE = (0.0, 0.0, 0.0)


def straight(speed: float, heading: float = 0.0, steps: int = 10) -> Array:
    way = speed * STEP * np.arange(1, steps + 1)
    return np.column_stack([way * np.cos(heading), way * np.sin(heading), np.full(steps, heading)])


def trials(paths: list[Array], *, stops: bool = False) -> list[TriedPath]:
    return [TriedPath(number, path, stops) for number, path in enumerate(paths)]


class People:
    """People who walk on, stop beside a robot that drives, or speed up along x, m/s²."""

    def __init__(self, people: list[list[float]], *, shy: bool = False, gain: float = 0.0) -> None:
        self.rows, self.shy, self.gain, self.asked = np.array(people), shy, gain, 0

    def truth(self) -> Truth:
        return Truth(
            pose=Pose(*HERE),
            velocity=(0.0, 0.0, 0.0),
            people=self.rows[:, :2],
            people_velocity=self.rows[:, 2:],
            people_radius=np.full(len(self.rows), 0.2),
            people_id=np.arange(len(self.rows)),
            foresee=self._foresee,
        )

    def _foresee(self, steps: int, step: float, path: Array | None) -> Array:
        assert path is not None
        assert path.shape == (steps + 1, 3)
        self.asked += 1
        drives = np.any(path[1:, :2] != path[0, :2])
        times = step * np.arange(1, steps + 1)[:, np.newaxis, np.newaxis]
        going = 0.0 if self.shy and drives else 1.0
        hurry = np.array([0.5 * self.gain, 0.0]) * times**2
        return np.asarray(self.rows[:, :2] + going * times * self.rows[:, 2:] + hurry)


def test_the_first_clear_plan_is_taken() -> None:
    ahead = People([[1.0, 0.0, 0.0, 0.0]])
    plans = [straight(0.65), straight(0.65, 0.1), straight(0.65, 1.2), straight(0.0)]
    assert Rehearsal(1.5, ROBOT).first_clear(ahead.truth(), trials(plans), HERE) == 2


def test_what_people_do_for_a_plan_decides() -> None:
    """A person who crosses would be touched, but stops for a robot that drives."""
    crossing = [[0.7, 0.9, 0.0, -0.9]]
    plans = [straight(0.65), straight(0.0)]
    found = [
        Rehearsal(1.5, ROBOT).first_clear(People(crossing, shy=shy).truth(), trials(plans), HERE)
        for shy in (False, True)
    ]
    assert found == [1, 0]


def test_a_robot_that_stands_touches_no_one() -> None:
    comes = People([[0.8, 0.0, -1.0, 0.0]])
    plans = [straight(0.65), straight(0.0)]
    assert Rehearsal(1.5, ROBOT).first_clear(comes.truth(), trials(plans), HERE) == 1


def test_where_a_plan_may_end_in_a_stop_no_one_walks_into_it_either() -> None:
    """A robot that has just cut in is at fault even if it stands."""
    comes = People([[1.5, 0.0, -1.0, 0.0]])
    beginning = trials([straight(0.0)], stops=True)
    both = [*beginning, TriedPath(1, straight(0.65, 1.4), stops=False)]
    assert Rehearsal(1.5, ROBOT).first_clear(comes.truth(), both, HERE) == 1


def test_a_plan_that_drives_someone_aside_is_not_taken() -> None:
    """A person ahead hurries away from the robot, who is never touched."""
    flees = People([[0.5, 0.0, 0.0, 0.0]], gain=1.0)
    plans = trials([straight(0.65), straight(0.3)])
    assert Rehearsal(1.5, ROBOT).first_clear(flees.truth(), plans, HERE) == 1


def test_of_plans_that_all_touch_the_last_to_do_so() -> None:
    around = People([[np.cos(a), np.sin(a), 0.0, 0.0] for a in np.linspace(0.0, 6.0, 20)])
    plans = [straight(0.65), straight(0.5), straight(0.6)]
    assert Rehearsal(1.5, ROBOT).first_clear(around.truth(), trials(plans), HERE) == 1


def test_the_crowd_is_not_asked_where_no_one_is_near() -> None:
    far = People([[9.0, 0.0, -0.5, 0.0]])
    assert Rehearsal(1.5, ROBOT).first_clear(far.truth(), trials([straight(0.65)]), HERE) == 0
    assert far.asked == 0


@pytest.mark.parametrize("yaw", [0.0, 1.0])
def test_every_disc_of_the_robot_counts(yaw: float) -> None:
    """A long robot that turns on the spot hits with its nose."""
    long = np.array([[0.0, 0.0, 0.2], [0.6, 0.0, 0.2]])
    beside = People([[0.6 * np.cos(yaw), 0.6 * np.sin(yaw), 0.0, 0.0]])
    turning = straight(0.0) + np.column_stack([0.1 * np.arange(1, 11), np.zeros((10, 2))])
    turning[:, 2] = yaw
    stays = straight(0.0)
    stays[:, 2] = yaw + 2.0
    plans = [turning, stays]
    assert Rehearsal(1.5, long).first_clear(beside.truth(), trials(plans), (0.0, 0.0, yaw)) == 1


def test_further_plans_are_not_made_before_they_are_needed() -> None:
    made = []

    def plans() -> Iterator[TriedPath]:
        for number in range(3):
            made.append(number)
            yield TriedPath(number, straight(0.65), stops=False)

    assert (
        Rehearsal(1.5, ROBOT).first_clear(People([[9.0, 3.0, 0.0, 0.0]]).truth(), plans(), HERE)
        == 0
    )
    assert made == [0]


def test_an_empty_crowd() -> None:
    empty = People(np.zeros((0, 4)).tolist())
    empty.rows = np.zeros((0, 4))
    assert Rehearsal(1.5, ROBOT).first_clear(empty.truth(), trials([straight(0.65)]), HERE) == 0
