"""Counter-based noise."""

import hashlib

import numpy as np
import pytest

from crowdbot.core.sensing.noise import SensorStream, sensor_rng


def test_same_arguments_same_numbers() -> None:
    first = sensor_rng(3, "robot", "front", 17).standard_normal(5)
    sensor_rng(3, "robot", "rear", 17).standard_normal(100)
    np.testing.assert_array_equal(first, sensor_rng(3, "robot", "front", 17).standard_normal(5))


def test_live_generators_do_not_disturb_each_other() -> None:
    a, b = sensor_rng(0, "r", "s", 1), sensor_rng(0, "r", "s", 1)
    a.random(1000)
    np.testing.assert_array_equal(b.random(3), sensor_rng(0, "r", "s", 1).random(3))


@pytest.mark.parametrize(
    "other", [(1, "r", "s", 0), (0, "q", "s", 0), (0, "r", "t", 0), (0, "r", "s", 1)]
)
def test_every_argument_counts(other: tuple[int, str, str, int]) -> None:
    assert not np.any(sensor_rng(0, "r", "s", 0).random(8) == sensor_rng(*other).random(8))


def test_names_do_not_run_together() -> None:
    assert sensor_rng(1, "a", "bc", 0).random() != sensor_rng(1, "ab", "c", 0).random()


def test_ticks_share_no_numbers() -> None:
    """Even long readings: the tick is not the low word of the counter."""
    draws = np.concatenate([sensor_rng(0, "r", "s", k).random(4096) for k in range(20)])
    assert len(np.unique(draws)) == len(draws)


def test_known_numbers() -> None:
    """Pinned: a change here changes every recorded run."""
    assert sensor_rng(7, "robot", "front_lidar", 128).integers(0, 2**63, 2).tolist() == PINNED


def test_normal_over_ticks() -> None:
    draws = np.array([sensor_rng(0, "r", "s", k).standard_normal() for k in range(20_000)])
    assert abs(draws.mean()) < 4 / np.sqrt(len(draws))
    assert abs(draws.std() - 1.0) < 4 / np.sqrt(2 * len(draws))
    assert abs(np.corrcoef(draws[:-1], draws[1:])[0, 1]) < 4 / np.sqrt(len(draws))


PINNED = [4532195993042903387, 7171273591752941206]


def test_a_stream_may_be_read_in_any_order() -> None:
    stream = SensorStream(3, "robot", "front")
    key = np.frombuffer(hashlib.sha256(b"3\0robot\0front").digest()[:16], "<u8")
    stream.at(9).random(3, dtype=np.float32)  # half a word is left over
    for tick in (17, 2**40, 0, 17):
        new = np.random.Philox(key=key, counter=np.array([0, tick, 0, 0], np.uint64))
        expected = np.random.Generator(new).standard_normal(7)
        np.testing.assert_array_equal(stream.at(tick).standard_normal(7), expected)
