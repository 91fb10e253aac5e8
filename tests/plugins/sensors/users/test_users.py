"""Synthetic users: each has the fault that its spec names, and no other."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.sensing.context import SensorContext
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.scene import Scene
from crowdbot.plugin import Pose
from crowdbot.plugins.sensors.users.users import (
    BiasedUserSpec,
    DelayedUserSpec,
    FatiguedUserSpec,
    GoalDirectedUserSpec,
    NoisyUserSpec,
    OneSwitchUserSpec,
    UserSpec,
)
from crowdbot.plugins.sensors.users.users_build import build
from crowdbot.testing.sensor_scenes import context

#: The steady robot of most tests, 8 m and more from the goal.
HERE = Pose(0.0, 0.0, 0.0)


def scene(*people: tuple[float, float]) -> Scene:
    """People of 0.25 m who stand."""
    found = Scene((), (0.0, 2.5), [0.25] * len(people), [1.75] * len(people))
    rows = np.array([[x, y, 0.0, 0.0] for x, y in people], np.float64).reshape(-1, 4)
    found.update(None, rows, np.ones(len(people), np.bool_))
    return found


def use(
    spec: UserSpec, poses: list[Pose], around: Scene | None = None, seed: int = 0
) -> NDArray[np.float64]:
    """Commands at these poses, at the user's rate."""
    user, robot = build(spec, context()), around or scene()
    memory = np.zeros(user.info().memory)
    rows = [
        user.read(robot, pose, k / spec.rate, sensor_rng(seed, "robot", "joystick", k), memory)
        for k, pose in enumerate(poses)
    ]
    return np.array(rows)


def ideal(**more: Any) -> GoalDirectedUserSpec:
    return GoalDirectedUserSpec(goal=(20.0, 0.0), max_speed=1.0, max_yaw_rate=1.5, **more)


def test_a_free_way_is_driven_straight_at_full_speed() -> None:
    assert use(ideal(), [HERE])[0] == pytest.approx([1.0, 0.0])


def test_the_goal_attracts_as_in_the_model() -> None:
    """Fajen and Warren's stiffness over damping, at 20 m: only the floor of the decay is left."""
    w = use(ideal(), [Pose(0.0, 0.0, -0.2)])[0, 1]
    assert w == pytest.approx(7.5 / 3.25 * 0.2 * (math.exp(-8.0) + 0.4), rel=0.05)


def test_a_person_on_the_left_is_passed_on_the_right_and_ahead_slows() -> None:
    _, w = use(ideal(), [HERE], scene((2.0, 0.3)))[0]
    assert w < -0.1
    v, _ = use(ideal(), [HERE], scene((0.828, 0.0)))[0]
    assert v == pytest.approx((0.828 - 0.25 - 0.178) / 0.5)
    blind = use(ideal(sight=0.0), [HERE], scene((0.8, 0.0)))[0]
    assert blind == pytest.approx([1.0, 0.0])


def test_whom_it_does_not_see_does_not_matter() -> None:
    behind, far = scene((-1.0, 0.1)), scene((9.0, 0.1))
    for around in (behind, far):
        assert use(ideal(), [HERE], around)[0] == pytest.approx([1.0, 0.0])


def test_it_stops_at_the_goal() -> None:
    assert use(ideal(), [Pose(20.0, 0.0, 0.0)])[0] == pytest.approx([0.0, 0.0])


def test_the_delayed_user_does_the_same_later() -> None:
    """Half a second of readings at 16 Hz, and until then the stick is centred."""
    poses = [Pose(0.0, 0.0, 0.02 * k) for k in range(40)]
    same: dict[str, Any] = {"goal": (20.0, 0.0), "max_speed": 1.0, "max_yaw_rate": 1.5}
    late = use(DelayedUserSpec(delay=0.5, **same), poses)
    assert np.array_equal(late[8:], use(ideal(), poses)[:-8])
    assert not late[:8].any()


def test_the_noisy_hand_has_the_spread_of_its_spec() -> None:
    spec = NoisyUserSpec(goal=(20.0, 0.0), max_speed=1.0, max_yaw_rate=1.5, noise=0.1,
                         proportional_noise=0.0, noise_time=0.1)  # fmt: skip
    w = use(spec, [HERE] * 4000)[:, 1] / 1.5
    assert (w.mean(), w.std()) == (pytest.approx(0.0, abs=0.01), pytest.approx(0.1, rel=0.06))


def test_the_biased_user_drives_to_the_left_of_everything() -> None:
    spec = BiasedUserSpec(goal=(20.0, 0.0), max_speed=1.0, max_yaw_rate=1.5, bias=0.2)
    assert use(spec, [HERE])[0] == pytest.approx(use(ideal(), [Pose(0.0, 0.0, -0.2)])[0])
    before = scene((0.8, 0.4))
    assert use(spec, [HERE], before)[0, 0] > use(ideal(), [HERE], before)[0, 0]


def test_one_switch_waits_for_its_mark_and_stops_by_the_next_press() -> None:
    """Ahead is lit in the first second: the press is its reaction later; then the goal is near."""
    spec = OneSwitchUserSpec(goal=(20.0, 0.0), max_speed=1.0, max_yaw_rate=1.5, reaction=0.5,
                             reaction_spread=0.0, deflection=0.5)  # fmt: skip
    found = use(spec, [HERE] * 16 + [Pose(20.0, 0.0, 0.0)] * 16)
    assert not found[:8].any()
    assert np.allclose(found[8:24], [0.5, 0.0])
    assert not found[24:].any()


def test_one_switch_takes_left_when_left_is_lit() -> None:
    spec = OneSwitchUserSpec(goal=(20.0, 0.0), max_speed=1.0, max_yaw_rate=1.5, reaction=0.5,
                             reaction_spread=0.0, deflection=0.5)  # fmt: skip
    found = use(spec, [Pose(0.0, 0.0, -1.5)] * 40)
    assert not found[:24].any()  # the second mark is lit after one second
    assert np.allclose(found[24:], [0.0, 0.75])


def test_a_tired_user_is_shakier_later_and_absent() -> None:
    same: dict[str, Any] = {"goal": (20.0, 0.0), "max_speed": 1.0, "max_yaw_rate": 1.5}
    hand: dict[str, Any] = {"noise": 0.05, "noise_time": 0.1, "delay": 0.0, "tired_delay": 0.0}
    rested, tired = (
        use(FatiguedUserSpec(**same, **hand, lapses=0.0, time_on_task=s), [HERE] * 2000)[:, 1].std()
        for s in (0.0, 1e5)
    )
    assert 1.7 < tired / rested < 2.1
    spec = FatiguedUserSpec(**same, lapses=0.5, time_on_task=1e5, delay=0.0, tired_delay=0.0)
    found = use(spec, [HERE] * 1000)
    held = np.all(np.diff(found, axis=0) == 0.0, axis=1).mean()
    assert 0.2 < held < 0.45  # a lapse of 1 s begins after 2 s of attention


@pytest.mark.parametrize("kind", [NoisyUserSpec, OneSwitchUserSpec, FatiguedUserSpec])
def test_equal_seeds_are_equal_users_and_others_are_not(kind: Callable[[], UserSpec]) -> None:
    poses = [Pose(0.0, 0.0, 0.3 * math.sin(0.1 * k)) for k in range(100)]
    around = scene((3.0, 0.2), (2.0, -0.5))
    one, two, other = (use(kind(), poses, around, seed) for seed in (3, 3, 4))
    assert np.array_equal(one, two)
    assert not np.array_equal(one, other)


def test_two_readings_at_the_same_time_are_equal() -> None:
    user = build(FatiguedUserSpec(), context())
    memory = np.zeros(user.info().memory)
    rows = [user.read(scene(), HERE, 1.0, sensor_rng(0, "r", "j", k), memory) for k in range(2)]
    assert np.array_equal(rows[0], rows[1])


def test_a_robot_without_an_outline_has_no_user() -> None:
    bare = SensorContext(robot=context().robot, task=replace(context().task, robot=None))
    with pytest.raises(ValueError, match="outline"):
        build(GoalDirectedUserSpec(), bare)
