"""Times of a recording that are not in seconds, and the unit that fits the motion best."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crowdbot.core.types.arrays import Array

#: A median time step outside is not in seconds, s.
STEPS = (1e-4, 5.0)
#: The usual speed of robots and people, m/s, and time step, s: the unit nearest to it is told.
USUAL, _USUAL_STEP = 0.8, 0.05
#: Median speed of people that no crowd exceeds, m/s.
PERSON_SPEED = 5.0
#: Slower than anyone walks or drives, m/s.
CREEPING = 0.15
#: What whole numbers may count -> how many there are in a second.
_TICKS = {"numbers of frames": 25.0, "milliseconds": 1e3, "microseconds": 1e6, "nanoseconds": 1e9}


def findings(t: Array, speeds: dict[str, float]) -> Iterator[str]:
    """Yield a sentence if times (N,) are in another unit than seconds.

    Args:
        t: times as they were read.
        speeds: median speed of moving bodies by name, m/s, if times were seconds.
    """
    step = float(np.median(np.diff(t)))
    fastest = max(speeds.values(), default=None)
    if step < STEPS[0]:
        yield f"median time between samples {step:.3g} s: minutes or hours? Times are in seconds"
    elif step > STEPS[1]:
        yield f"median time between samples {step:.3g} s: {_advice(step, fastest)}"
    elif (
        fastest is not None
        and fastest < CREEPING <= 3.0 * fastest * _ticks(step, fastest)[1]
        and np.all(t == np.round(t))
    ):
        fastest_name = max(speeds, key=lambda name: speeds[name])
        yield (
            f"{fastest_name}: median speed {fastest:.3g} m/s, and all times are whole numbers: "
            f"{_advice(step, fastest)}"
        )


def _advice(step: float, speed: float | None) -> str:
    unit, rate = _ticks(step, speed)
    text = f"{unit}? Times are in seconds; frame_rate={rate:.0f} reads these"
    return text if speed is None else f"{text}, with a median speed of {speed * rate:.3g} m/s"


def _ticks(step: float, speed: float | None) -> tuple[str, float]:
    """Return the unit of times, and the number of units per second."""

    def off(rate: float) -> float:
        of_step = abs(math.log(step / rate / _USUAL_STEP))
        if speed is None:
            return of_step
        within = STEPS[0] <= step / rate <= STEPS[1]
        return abs(math.log(speed * rate / USUAL)) + (0.0 if within else 100.0)

    return min(_TICKS.items(), key=lambda item: off(item[1]))


def apart(x: Array) -> str | None:
    """Return a sentence if no two of several people who are there together share a sample.

    Args:
        x: (T, N) of people, NaN where absent.
    """
    there = np.isfinite(x)
    if x.shape[1] < 2 or len(x) < 2 * x.shape[1] or there.sum(axis=1).max(initial=0) > 1:
        return None
    present = there.any(axis=0)
    first = np.argmax(there, axis=0)[present]
    last = len(x) - 1 - np.argmax(there[::-1], axis=0)[present]
    together = int(np.max([np.sum((first <= k) & (last >= k)) for k in first], initial=0))
    if together < 2:
        return None
    return (
        f"people: {together} are there together, and no two at one time: a stamp for each row? "
        "resample=10 brings them to common times"
    )
