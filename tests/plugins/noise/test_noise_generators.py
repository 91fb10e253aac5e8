"""Errors of sensors, and the other options that all proximity sensors share."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crowdbot.core.sensing.build import build_sensor
from crowdbot.core.sensing.noise import sensor_rng
from crowdbot.core.sensing.range_model import RangeModel
from crowdbot.core.sensing.sensor import NoiseGenerator
from crowdbot.plugins.noise.gaussian import GaussianSpec
from crowdbot.plugins.sensors.lidar2d import Lidar2dSpec
from crowdbot.plugins.sensors.ultrasound import UltrasoundSpec
from crowdbot.testing.sensor_scenes import context
from tests.core.sensing.sensing_worlds import REGISTRY, Array, read, scene_of, sensor

BEAMS = 200_000
AT = 5.0


def _noise(built: object) -> NoiseGenerator:
    return cast(NoiseGenerator, built)


def errors(tick: int = 0, **options: Any) -> Array:
    """What is read where everything is 5 m away, minus that."""
    spec = REGISTRY.spec_model("sensor", "ultrasound").model_validate(
        {"kind": "ultrasound", "range_min": 0.0, "range_max": 10.0, **options}
    )
    assert isinstance(spec, UltrasoundSpec)
    noise = [REGISTRY.build(spec.noise[name], _noise) for name in sorted(spec.noise)]
    distance = np.full(BEAMS, AT)
    return RangeModel(spec, noise).measure(distance, sensor_rng(0, "r", "s", tick)) - AT


def one(kind: str, **fields: Any) -> dict[str, Any]:
    return {"noise": {"it": {"kind": kind, **fields}}}


def test_gaussian() -> None:
    got = errors(**one("gaussian", std="2 cm", mean="1 cm"))
    assert got.mean() == pytest.approx(0.01, abs=4 * 0.02 / math.sqrt(BEAMS))
    assert got.std() == pytest.approx(0.02, rel=4 / math.sqrt(2 * BEAMS))
    assert np.mean(np.abs(got - 0.01) < 0.02) == pytest.approx(math.erf(math.sqrt(0.5)), abs=0.005)


def test_offset() -> None:
    np.testing.assert_allclose(errors(**one("offset", value="-3 cm")), -0.03, atol=1e-12)


def test_peak() -> None:
    got = errors(**one("peak", probability=0.05, mean=2.0, std=0.5))
    struck = got != 0.0
    assert struck.mean() == pytest.approx(0.05, abs=4 * math.sqrt(0.05 * 0.95 / BEAMS))
    assert got[struck].mean() == pytest.approx(2.0, abs=4 * 0.5 / math.sqrt(struck.sum()))
    assert got[struck].std() == pytest.approx(0.5, rel=0.05)
    assert not errors(**one("peak", probability=0.0)).any()


def test_a_stack_adds_up_whatever_the_order_in_which_it_is_written() -> None:
    stack = {
        "b": {"kind": "gaussian", "std": 0.1},
        "c": {"kind": "peak", "mean": 1.0},
        "a": {"kind": "offset", "value": 0.5},
    }
    got = errors(noise=stack)
    turned = errors(noise=dict(reversed(stack.items())))
    np.testing.assert_array_equal(got, turned)
    rng = sensor_rng(0, "r", "s", 0)
    normal = 0.1 * rng.standard_normal(BEAMS)
    peaks = (rng.random(BEAMS) < 0.01) * (1.0 + rng.standard_normal(BEAMS))
    expected = np.clip(AT + 0.5 + normal + peaks, 0.0, 10.0) - AT
    np.testing.assert_allclose(got, expected, atol=1e-12)


def test_a_length_is_one_gaussian() -> None:
    np.testing.assert_array_equal(
        errors(noise="3 mm"), errors(noise={"range": {"kind": "gaussian", "std": 0.003}})
    )
    assert sensor("lidar2d", noise=0).info().random is False
    assert sensor("lidar2d", noise={}).info().random is False
    assert sensor("lidar2d", noise="1 mm").info().random is True
    assert sensor("lidar2d", **one("offset", value=0.1)).info().random is False
    assert sensor("lidar2d", dropout=0.1).info().random is True


def test_specs_may_hold_generators_that_are_made_already() -> None:
    spec = Lidar2dSpec(noise={"mine": GaussianSpec(std=0.25)})
    assert build_sensor(REGISTRY, spec, context()).info().random is True
    assert spec.model_dump()["noise"] == {"mine": {"kind": "gaussian", "std": 0.25, "mean": 0.0}}


@pytest.mark.parametrize("kind", ["gaussian", "peak"])
def test_sensors_and_ticks_are_independent(kind: str) -> None:
    fields: dict[str, Any] = {"std": 0.1} if kind == "gaussian" else {"probability": 0.3}
    first, second = errors(0, **one(kind, **fields)), errors(1, **one(kind, **fields))
    assert abs(np.corrcoef(first, second)[0, 1]) < 4 / math.sqrt(BEAMS)
    assert abs(np.corrcoef(first[:-1], first[1:])[0, 1]) < 4 / math.sqrt(BEAMS)


def test_a_beam_draws_the_same_whatever_the_others_hit() -> None:
    """Misses stay misses; hits keep their errors and dropouts."""
    lidar = sensor("lidar2d", noise={"a": {"kind": "peak"}, "b": {"kind": "gaussian", "std": 0.1}},
                   dropout=0.2)  # fmt: skip
    box = [[3.0, -9.0, 3.0, 9.0], [-9.0, 3.0, 9.0, 3.0]]
    both, single = read(lidar, scene_of(walls=box)), read(lidar, scene_of(walls=box[:1]))
    same = slice(110, 300)  # beams that meet the first wall in either scene
    np.testing.assert_array_equal(both[same], single[same])
    assert np.isinf(single[:60]).all()


@pytest.mark.parametrize("share", [0.01, 0.3, 0.9])
def test_dropout_rate(share: float) -> None:
    lost = np.isinf(errors(dropout=share))
    assert lost.mean() == pytest.approx(share, abs=4 * math.sqrt(share * (1 - share) / BEAMS))


@pytest.mark.slow
@settings(max_examples=60)
@given(st.integers(1, 16), st.floats(0.0, 1.0), st.floats(1.5, 20.0), st.floats(0.0, 1.0))
def test_readings_are_whole_steps(bits: int, low: float, high: float, share: float) -> None:
    lidar = sensor("lidar2d", bits=bits, range_min=low, range_max=high)
    true = low + share * (high - low)
    wall = [[true, -50.0, true, 50.0]]
    got = float(read(lidar, scene_of(walls=wall, robot_z=0.0))[240])
    step = (high - low) / 2**bits
    exact = float(read(sensor("lidar2d", range_min=low, range_max=high), scene_of(walls=wall))[240])
    if math.isinf(exact):  # the wall is at the very end of the range
        assert math.isinf(got)
        return
    assert got <= exact + 1e-9
    assert got > exact - step * (1 + 1e-9) or got == low
    whole = got / step
    assert got == low or whole == pytest.approx(round(whole), abs=1e-6)


def test_the_step_of_eight_bits() -> None:
    """4.3 m in 256 steps: 16.8 mm, the class of a cheap sonar."""
    one_step = sensor("ultrasound", bits=8)
    walls = [[[x, -9.0, x, 9.0]] for x in np.linspace(1.0, 2.0, 400)]
    values = np.unique([read(one_step, scene_of(walls=w))[0] for w in walls])
    np.testing.assert_allclose(np.diff(values), 4.3 / 256, rtol=1e-9)


def test_incidence_limit_of_a_lidar() -> None:
    """A wall 3 m ahead: the beam at 50 deg meets it at 50 deg to its normal."""
    wall = scene_of(walls=[[3.0, -99.0, 3.0, 99.0]])
    everything, limited = (
        read(sensor("lidar2d", range_max=90.0, **fields), wall)
        for fields in ({}, {"max_incidence": "50.2 deg"})
    )
    seen = np.isfinite(limited)
    assert seen.sum() == 201
    assert seen[140:341].all()
    np.testing.assert_array_equal(limited[seen], everything[seen])
