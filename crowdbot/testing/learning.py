"""Checks for every observation and every reward for training policies."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, cast

import numpy as np

from crowdbot.core.learning.build import (
    CheckedObserver,
    CheckedReward,
    build_observer,
    build_reward,
)
from crowdbot.core.learning.seen import LearningContext, RobotInputs, StepChange
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.robot import RobotBody, RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import ObservationSpec, RewardSpec
from crowdbot.testing.around import around, specs_of

_LIMITS = RobotLimits(v_min=-0.5, v_max=1.0, w_max=2.0, a_max=1.0, alpha_max=3.0)
_BODY = RobotBody(
    drive="differential", radius=0.3, footprint=None, front=0.3, back=0.3, half_width=0.3
)
_WORLDS, _BEAMS = 4, 90


def check_vectors_are_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """Observations are finite, of one shape, and within ``low`` and ``high``.

    If this fails, divide by the largest value, and clip what may be larger.
    """
    for observer in _observers(component, registry, _WORLDS):
        for seen in _sights(_WORLDS):
            found = observer.observe(seen)
            assert np.all(found >= observer.low - 1e-6), "a number is below its bound"
            assert np.all(found <= observer.high + 1e-6), "a number is above its bound"


def check_sights_are_unchanged(component: Component[Any], registry: Registry | None = None) -> None:
    """The arrays that an observer gets are not written to.

    If this fails, copy before you change.
    """
    for observer in _observers(component, registry, _WORLDS):
        for seen, before in zip(_sights(_WORLDS), _sights(_WORLDS), strict=True):
            observer.observe(seen)
            for one, other in zip(_arrays(seen), _arrays(before), strict=True):
                assert np.array_equal(one, other, equal_nan=True), "an input was changed"


def check_worlds_are_apart(component: Component[Any], registry: Registry | None = None) -> None:
    """A world's observation does not depend on the other worlds, or on earlier episodes.

    If this fails, keep what you remember for each world, and forget it where ``fresh`` is true.
    """
    for w in range(_WORLDS):
        whole, single = (_observers(component, registry, n) for n in (_WORLDS, 1))
        for all_of_them, one in zip(whole, single, strict=True):
            for seen in _sights(_WORLDS):
                together, alone = all_of_them.observe(seen), one.observe(_only(seen, w))
                assert np.allclose(together[w], alone[0], atol=1e-6), "worlds are mixed up"


def check_rewards_are_numbers(component: Component[Any], registry: Registry | None = None) -> None:
    """Rewards are finite, one for each world.

    If this fails, look at a gap that is infinite, and at a robot that stands.
    """
    for reward in _rewards(component, registry, _WORLDS):
        for change in _changes(_WORLDS):
            reward.of(change)


def check_rewards_are_apart(component: Component[Any], registry: Registry | None = None) -> None:
    """A world's reward does not depend on the other worlds, or on earlier steps.

    If this fails, keep nothing between two steps.
    """
    together = [
        [r.of(c) for c in _changes(_WORLDS)] for r in _rewards(component, registry, _WORLDS)
    ]
    for w in range(_WORLDS):
        for number, one in enumerate(_rewards(component, registry, 1)):
            for k, change in reversed(list(enumerate(_changes(_WORLDS)))):
                own = one.of(_only(change, w))
                assert np.allclose(own[0], together[number][k][w]), "worlds are mixed up"


def check_a_second_look_is_the_same(
    component: Component[Any], registry: Registry | None = None
) -> None:
    """A second observation without a step in between is the same as the first.

    If this fails, add to what you remember only where ``stepped`` is true.
    """
    for observer in _observers(component, registry, _WORLDS):
        for seen in _sights(_WORLDS):
            first, none = observer.observe(seen), np.zeros(_WORLDS, np.bool_)
            again = observer.observe(replace(seen, fresh=none, stepped=none))
            assert np.array_equal(first, again), "a second look differs"


OBSERVATION_CHECKS: tuple[Callable[..., None], ...] = (
    check_vectors_are_numbers,
    check_sights_are_unchanged,
    check_worlds_are_apart,
    check_a_second_look_is_the_same,
)
REWARD_CHECKS: tuple[Callable[..., None], ...] = (
    check_rewards_are_numbers,
    check_rewards_are_apart,
)


def _context(worlds: int) -> LearningContext:
    angles = np.linspace(-2.0, 2.0, _BEAMS)
    info = SensorInfo(
        category="lidar", frame="lidar", mount=(0.1, 0.0, 0.3, 0.0), rate=16.0, shape=(_BEAMS,),
        ros_type="sensor_msgs/msg/LaserScan", angles=angles, range_min=0.1, range_max=10.0,
    )  # fmt: skip
    return LearningContext(worlds=worlds, limits=_LIMITS, body=_BODY, sensors={"lidar": info})


def _observers(
    component: Component[Any], registry: Registry | None, worlds: int
) -> Iterator[CheckedObserver]:
    known = around(component, registry)
    for spec in specs_of(component, known):
        yield build_observer(known, cast(ObservationSpec, spec), _context(worlds))


def _rewards(
    component: Component[Any], registry: Registry | None, worlds: int
) -> Iterator[CheckedReward]:
    known = around(component, registry)
    for spec in specs_of(component, known):
        yield build_reward(known, cast(RewardSpec, spec), _context(worlds))


def _sights(worlds: int) -> list[RobotInputs]:
    """Return random inputs of five steps for all worlds; world 1 starts a new episode midway."""
    rng, sights = np.random.default_rng(3), []
    for step in range(5):
        people = rng.uniform(-8.0, 8.0, (worlds, 12, 5))
        people[:, :, 4] = 0.3
        people[rng.random((worlds, 12)) < 0.3] = np.nan
        ranges = rng.uniform(0.1, 10.0, (worlds, _BEAMS))
        ranges[rng.random((worlds, _BEAMS)) < 0.5] = np.inf
        fresh = np.full(worlds, step == 0)
        fresh[1] = step in (0, 3)
        sights.append(
            RobotInputs(
                fresh=fresh,
                stepped=np.full(worlds, step > 0),
                pose=rng.uniform(-4.0, 4.0, (worlds, 3)),
                twist=rng.uniform(-1.5, 1.5, (worlds, 3)) * [1.0, 1.0, 0.0],
                goal=rng.uniform(-30.0, 30.0, (worlds, 2)),
                readings={"lidar": np.full_like(ranges, np.inf) if step == 4 else ranges},
                people=people[:, : 0 if step == 4 else 12],
            )
        )
    return sights


def _changes(worlds: int) -> list[StepChange]:
    rng, changes = np.random.default_rng(4), []
    for step in range(4):
        gap = rng.uniform(-0.1, 3.0, worlds)
        gap[0] = np.inf if step == 0 else gap[0]
        changes.append(
            StepChange(
                progress=rng.uniform(-0.1, 0.1, worlds),
                distance=rng.uniform(0.0, 30.0, worlds),
                arrived=rng.random(worlds) < 0.3,
                contact=rng.uniform(0.0, 1.0, worlds) * (gap < 0.0),
                wall=np.zeros(worlds),
                gap=gap,
                advance=rng.uniform(0.0, 0.1, worlds),
                work=rng.uniform(0.0, 20.0, worlds),
                forced=rng.uniform(0.0, 0.3, worlds),
                aside=rng.uniform(0.0, 1.0, worlds),
                command=rng.uniform(-0.5, 1.0, (worlds, 3)) * [1.0, 1.0, 0.0],
                before=np.zeros((worlds, 3)),
            )
        )
    return changes


def _only(given: Any, w: int) -> Any:
    """Return an observation or reward input reduced to world ``w``."""
    names = type(given).__dataclass_fields__
    values = {name: getattr(given, name) for name in names}
    readings = values.pop("readings", None)
    cut: dict[str, Any] = {name: value[w : w + 1] for name, value in values.items()}
    if readings is not None:
        cut["readings"] = {name: ranges[w : w + 1] for name, ranges in readings.items()}
    return replace(given, **cut)


def _arrays(seen: RobotInputs) -> list[Any]:
    return [
        seen.fresh,
        seen.stepped,
        seen.pose,
        seen.twist,
        seen.goal,
        *seen.readings.values(),
        seen.people,
    ]
