"""Build functions of sensors without a context, as third parties wrote them before it came."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from crowdbot.core.registry.build_reference import accepted
from crowdbot.plugins.crowd.policies.replay import REPLAY
from crowdbot.plugins.sensors.imu import IMU
from crowdbot.plugins.sensors.lidar2d import LIDAR2D


class Old:
    def __init__(self, spec: Any) -> None: ...


class New:
    def __init__(self, spec: Any, context: Any) -> None: ...


def everything(*given: Any) -> None: ...
def new(spec: Any, context: Any) -> None: ...
def new_by_another_name(spec: Any, carrier: Any) -> None: ...
def new_with_a_default(spec: Any, context: Any = None) -> None: ...
def new_and_more(spec: Any, context: Any, option: int = 1) -> None: ...
def old(spec: Any) -> None: ...
def old_and_more(spec: Any, option: int = 1) -> None: ...
def noisy(spec: Any, noise: Any, context: Any) -> None: ...
def old_noisy(spec: Any, noise: Any) -> None: ...
def old_perhaps_noisy(spec: Any, noise: Any = ()) -> None: ...


@pytest.mark.parametrize(
    "build", [New, everything, new, new_by_another_name, new_with_a_default, new_and_more]
)
def test_functions_with_a_place_for_it_get_the_context(build: Callable[..., object]) -> None:
    assert accepted(IMU, build, ["context"]) == ["context"]


@pytest.mark.parametrize("build", [Old, old, old_and_more])
def test_functions_without_a_place_for_it_are_called_as_before(
    build: Callable[..., object],
) -> None:
    with pytest.warns(DeprecationWarning, match="'imu': .*imu_build:build' takes no context"):
        assert accepted(IMU, build, ["context"]) == []


@pytest.mark.parametrize("build", [old_noisy, old_perhaps_noisy])
def test_noise_generators_come_before_the_context(build: Callable[..., object]) -> None:
    with pytest.warns(DeprecationWarning, match="lidar2d"):
        assert accepted(LIDAR2D, build, ["noise", "context"]) == ["noise"]
    assert accepted(LIDAR2D, noisy, ["noise", "context"]) == ["noise", "context"]


def test_only_sensors_may_be_without_their_last_argument() -> None:
    given = ["costs", "agents"]
    assert accepted(REPLAY, old_noisy, given) is given
