"""Counter-based random numbers for sensors.

Philox (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011): the key
names the sensor, the counter the tick. A reading therefore depends neither on other sensors nor on
earlier readings.
"""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
from numpy.random.bit_generator import ISeedSequence
from numpy.typing import NDArray


class _Key(ISeedSequence):
    """Passes Philox its key; a key given to its constructor would cost fresh entropy each time."""

    def __init__(self, key: NDArray[np.uint64]) -> None:
        self.key = key

    def generate_state(self, n_words: int, dtype: Any = np.uint32) -> NDArray[Any]:
        del n_words, dtype
        return self.key


def _key(run_seed: int, robot: str, sensor: str) -> _Key:
    digest = hashlib.sha256(f"{run_seed}\0{robot}\0{sensor}".encode()).digest()
    return _Key(np.frombuffer(digest[:16], dtype="<u8").astype(np.uint64))


class SensorStream:
    """Random numbers of one sensor, reading by reading.

    Args:
        run_seed: ``--seed`` of the run.
        robot: its name in the scenario.
        sensor: its name on the robot.
    """

    def __init__(self, run_seed: int, robot: str, sensor: str) -> None:
        philox = np.random.Philox(_key(run_seed, robot, sensor))  # type: ignore[arg-type]
        self._generator, self._state = np.random.Generator(philox), philox.state

    def at(self, tick: int) -> np.random.Generator:
        """Return the generator for the reading at a tick of 1/128 s, not negative.

        Returns:
            the one generator of the stream, moved there; equal arguments give equal numbers,
            ticks never share any.
        """
        # The tick is the second of four counter words: there are 2^64 blocks between two ticks.
        self._state["state"]["counter"][1] = tick
        self._generator.bit_generator.state = self._state
        return self._generator


def sensor_rng(run_seed: int, robot: str, sensor: str, tick: int) -> np.random.Generator:
    """Return a new generator for one reading; arguments as in `SensorStream`."""
    return SensorStream(run_seed, robot, sensor).at(tick)
