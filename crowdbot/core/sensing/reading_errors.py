"""Errors added to the readings of a sensor of any kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.dsl.spec.reading_errors import GaussianError, OffsetError, PeakError, ReadingError
from crowdbot.errors import InputError


class ErringSensor:
    """A sensor with added errors, which are drawn after the sensor's own noise.

    Infinite and NaN values, such as beams without an echo, stay unchanged; a bumper's sectors are
    rounded to 0 or 1, so that an error is a false or a missed touch.

    Args:
        sensor: the sensor without errors.
        errors: what is added, in order.

    Raises:
        InputError: an error names a number that a reading does not have.
    """

    def __init__(self, sensor: Any, errors: Sequence[ReadingError]) -> None:
        self._sensor, self._errors = sensor, tuple(errors)
        info: SensorInfo = sensor.info()
        width = info.shape[-1]
        for error in self._errors:
            wrong = [n for n in error.entries or () if n >= width]
            if wrong:
                raise InputError(
                    f"errors.entries: {wrong[0]} is not a number of a reading of {info.category}, "
                    f"which has {width}: 0 to {width - 1}"
                )
        random = info.random or any(not isinstance(e, OffsetError) for e in self._errors)
        self._info = replace(info, random=random, scatter=_scatter(info, self._errors))
        self._two_valued = info.category == "bumper"

    def info(self) -> SensorInfo:
        """Return the constant description of the sensor; its readings may be random now."""
        return self._info

    def read(self, *given: Any) -> Array:
        """Return the sensor's reading with errors; arguments as in its interface."""
        values: Array = np.array(self._sensor.read(*given))
        rng: np.random.Generator = given[3]
        for error in self._errors:
            _add(values, error, rng)
        return np.where(values > 0.5, 1.0, 0.0) if self._two_valued else values


def _scatter(info: SensorInfo, errors: Sequence[ReadingError]) -> tuple[float, ...]:
    """Return the standard deviation of each number of a reading, which is one row of numbers."""
    if len(info.shape) != 1:
        return info.scatter
    squares = np.square(info.scatter or np.zeros(info.shape))
    for error in errors:
        squares[slice(None) if error.entries is None else list(error.entries)] += _variance(error)
    return tuple(np.sqrt(squares).tolist())


def _variance(error: ReadingError) -> float:
    if isinstance(error, GaussianError):
        return error.std**2
    if isinstance(error, PeakError):
        mean = error.probability * error.mean
        return error.probability * (error.mean**2 + error.std**2) - mean**2
    return 0.0


def _add(values: Array, error: ReadingError, rng: np.random.Generator) -> None:
    """Add an error in place; the number of draws does not depend on the values."""
    chosen = slice(None) if error.entries is None else list(error.entries)
    part = values[..., chosen]
    if isinstance(error, GaussianError):
        off = error.mean + error.std * rng.standard_normal(part.shape)
    elif isinstance(error, PeakError):
        struck = rng.random(part.shape) < error.probability
        off = struck * (error.mean + error.std * rng.standard_normal(part.shape))
    else:
        off = np.full(part.shape, error.value)
    values[..., chosen] = np.where(np.isfinite(part), part + off, part)
