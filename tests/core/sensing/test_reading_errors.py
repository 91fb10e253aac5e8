"""Errors on any sensor: added to what it reads, drawn after it, refused where they do not fit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.types.robot import RobotState
from crowdbot.dsl.identity.canonical import content_hash
from crowdbot.errors import InputError, SpecError
from crowdbot.plugin import Pose, Scene
from tests.built_in import built_in
from tests.core.sensing.sensing_worlds import REGISTRY, scene_of, sensor

ERRORS: dict[str, dict[str, Any]] = {
    "gaussian": {"kind": "gaussian", "std": 0.1, "mean": 0.5},
    "offset": {"kind": "offset", "value": 0.25},
    "peak": {"kind": "peak", "probability": 0.5, "mean": 3.0, "std": 0.0},
}
KINDS = sorted(c.kind for c in built_in("sensor"))


def _world() -> Scene:
    return scene_of([[2.0, 0.2], [-1.5, 0.5]], [[3.0, -4.0, 3.0, 4.0]])


def _read(kind: str, scene: Scene, tick: int = 128, **fields: Any) -> np.ndarray[Any, Any]:
    one: Any = sensor(kind, **fields)
    info = one.info()
    memory = [np.zeros(info.memory)] if info.memory else []
    rng = sensor_rng(1, "robot", kind, tick)
    return np.asarray(one.read(scene, Pose(0.0, 0.0, 0.0), tick / 128, rng, *memory))


@pytest.mark.parametrize("error", ERRORS)
@pytest.mark.parametrize("kind", KINDS)
def test_every_sensor_takes_every_error(kind: str, error: str) -> None:
    scene = _world()
    plain = _read(kind, scene)
    erring = _read(kind, scene, errors={"e": ERRORS[error]})
    assert erring.shape == plain.shape
    finite = np.isfinite(plain)
    np.testing.assert_array_equal(np.isfinite(erring), finite)
    off = erring[finite] - plain[finite]
    if kind == "bumper":
        assert set(np.unique(erring)) <= {0.0, 1.0}
    elif error == "offset":
        np.testing.assert_allclose(off, 0.25, atol=1e-6)
    elif error == "peak":
        np.testing.assert_allclose(off[off != 0.0], 3.0, atol=1e-5)
    elif off.size:
        assert abs(off.mean() - 0.5) < 0.5
        assert np.all(off != 0.0)


def test_entries_and_order() -> None:
    errors = {"a": {"kind": "offset", "value": 1.0, "entries": [2]}, "b": ERRORS["offset"]}
    off = _read("imu", _world(), errors=errors) - _read("imu", _world())
    np.testing.assert_allclose(off, [0.25, 0.25, 1.25, 0.25, 0.25, 0.25], atol=1e-12)


def test_a_false_touch() -> None:
    error = {"kind": "peak", "probability": 1.0, "mean": 1.0, "std": 0.0}
    assert _read("bumper", _world(), errors={"e": error}).all()


def test_wrong_errors_are_refused() -> None:
    with pytest.raises(InputError, match=r"7 is not a number of a reading of imu.* 6: 0 to 5"):
        _read("imu", _world(), errors={"e": {"kind": "offset", "value": 1.0, "entries": [7]}})


def test_without_errors_the_hash_stays() -> None:
    plain = crowdbot.load("challenge-2020", "in-d0125-slow-c01-r02")
    same = crowdbot.load(
        "challenge-2020", "in-d0125-slow-c01-r02", set="robots.robot.sensors.imu.errors={}"
    )
    other = crowdbot.load(
        "challenge-2020",
        "in-d0125-slow-c01-r02",
        set="robots.robot.sensors.imu.errors={e: {kind: offset, value: 0.1}}",
    )
    hashes = [content_hash(s, REGISTRY.spec_versions(s)) for s in (plain, same, other)]
    assert hashes[0] == hashes[1] != hashes[2]
    with pytest.raises(SpecError, match="ofst"):
        crowdbot.load(
            "challenge-2020",
            "in-d0125-slow-c01-r02",
            set="robots.robot.sensors.imu.errors={e: {kind: ofst, value: 0.1}}",
        )


def test_base_odometry_is_the_truth() -> None:
    scene = _world()
    robot = RobotState(1.0, 2.0, 0.5, 0.3, 0.1, 0.2, 0.0, 0.0, 0.0, 0.0)
    scene.robot = robot
    one: Any = sensor("base_odometry")
    read = one.read(scene, Pose(1.0, 2.0, 0.5), 0.0, np.random.default_rng(0))
    c, s = np.cos(0.5), np.sin(0.5)
    expected = [1.0, 2.0, 0.5, 0.3 * c + 0.1 * s, 0.2, 0.1 * c - 0.3 * s]
    np.testing.assert_allclose(read, expected)
