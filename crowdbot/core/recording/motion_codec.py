"""Packs the motion of people without losing a bit: differences from a prediction.

People are predicted from their two samples before. Somebody who goes on wanting the same velocity
u comes closer to it by the same share in each step, ``v + (u - v) / gain``; and who turns mostly
keeps the speed that is wanted, so that of two components of u the larger one follows from the
smaller one. Positions follow from velocities tick by tick, as the simulation adds them up. What is
stored is the difference between the bits of a number and those of its prediction: 0 for nine
positions of ten, two or three bits for every other velocity.

Only additions, multiplications and square roots of float64 are used, which every machine rounds
alike. docs/reference/recording.md says it in formulas.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.support.compile import kernel
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array

#: Speeds remembered of each person.
SPEEDS = 3
#: Steps in which somebody would reach the velocity that is wanted, one of which is chosen.
GAINS = (8.0, 4.0, 2.0, 16.0, 1.0)
_SAMPLES_FOR_GAIN = 4
#: Longer steps, or those that are not whole ticks, are predicted as one tick.
_LONGEST = TICKS_PER_SECOND
_POSITIVE = 2**63 - 1
#: Entries of the numbers (4, M) of one sample.
_X, _Y, _VX, _VY = range(4)


class Packed(NamedTuple):
    """Samples of people, packed.

    Attributes:
        gain: which was chosen.
        data: byte by byte: which speed was taken, a byte for each number of a person and a sample;
            then of x, y, vx, vy each the eight bytes of all differences, lowest bytes first.
    """

    gain: float
    data: bytes


class MotionCodec:
    """Packs or unpacks the samples of one recording, in the order in which they were taken."""

    def __init__(self, people: int) -> None:
        self._people = people
        self._last_t = math.nan
        self._last = np.full((2, 4, people), np.nan)  # the sample before, and the one before that
        self._speeds = np.zeros((people, SPEEDS))
        self._oldest = np.zeros(people, np.int64)

    def pack(self, t: Array, motion: Array) -> Packed:
        """Pack samples.

        Args:
            t: (K,) times, s.
            motion: (K, 4, M) x, y, vx, vy; NaN where somebody is absent.
        """
        values = np.array(motion, np.float64)
        gain, taken, difference = self._best_gain(values), *self._space(len(t))
        self._code(t, values, gain, taken, difference, packs=True)
        planes = difference.view(np.uint8).reshape(4, -1, 8).transpose(0, 2, 1)
        return Packed(gain, taken.tobytes() + planes.tobytes())

    def unpack(self, t: Array, packed: Packed) -> Array:
        """The samples (K, 4, M) again, bit by bit.

        Raises:
            ValueError: the data are not those of so many samples and people.
        """
        values = np.zeros((len(t), 4, self._people))
        taken, difference = self._space(len(t))
        data = np.frombuffer(packed.data, np.uint8)
        if data.size != taken.size + difference.nbytes:
            raise ValueError(f"{data.size} bytes of {len(t)} samples of {self._people} people")
        taken.reshape(-1)[:] = data[: taken.size]
        planes = data[taken.size :].reshape(4, 8, -1).transpose(0, 2, 1)
        difference.view(np.uint8).reshape(4, -1, 8)[:] = planes
        self._code(t, values, packed.gain, taken, difference, packs=False)
        return values

    def _code(
        self,
        t: Array,
        values: Array,
        gain: float,
        taken: NDArray[np.uint8],
        difference: NDArray[np.int64],
        *,
        packs: bool,
    ) -> None:
        scratch = np.zeros(1)
        _code(
            packs, values, values.view(np.int64), self._steps(t), gain, self._last, self._speeds,
            self._oldest, scratch, scratch.view(np.int64), taken, difference,
        )  # fmt: skip

    def _space(self, samples: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
        """Which speeds are taken (K, M), and differences (4, K, M)."""
        taken = np.zeros((samples, self._people), np.uint8)
        return taken, np.zeros((4, samples, self._people), np.int64)

    def _steps(self, t: Array) -> NDArray[np.int64]:
        """(K,) ticks since the sample before; 1 where that is not a whole number."""
        gaps = np.diff(t, prepend=self._last_t) * TICKS_PER_SECOND
        self._last_t = float(t[-1]) if len(t) else self._last_t
        whole = (gaps >= 1.0) & (gaps <= _LONGEST) & (gaps == np.rint(gaps))
        return np.where(whole, gaps, 1.0).astype(np.int64)

    def _best_gain(self, values: Array) -> float:
        """The gain whose predictions of velocities are nearest in most places."""
        before = np.concatenate([self._last[::-1, _VX:], values[:_SAMPLES_FOR_GAIN, _VX:]])
        with np.errstate(all="ignore"):
            change = np.diff(before, axis=0)
            off = [
                np.abs(change[1:] - change[:-1] * ((gain - 1.0) / gain)) + 1e-18 for gain in GAINS
            ]
            cost = [float(np.nansum(np.log2(one))) for one in off]
        return GAINS[int(np.argmin(cost))]


@kernel
def _code(
    packs: bool,
    values: Array,
    bits: NDArray[np.int64],
    steps: NDArray[np.int64],
    gain: float,
    last: Array,
    speeds: Array,
    oldest: NDArray[np.int64],
    scratch: Array,
    scratch_bits: NDArray[np.int64],
    taken: NDArray[np.uint8],
    difference: NDArray[np.int64],
) -> None:
    """Fill ``taken`` and ``difference`` from ``values``, or the other way round.

    One function for both, so that they cannot predict differently.

    Args:
        packs: whether to pack.
        values, bits: (K, 4, M), the same memory.
        steps: (K,) ticks since the sample before.
        last, speeds, oldest: what was before, brought up to date.
        scratch, scratch_bits: (1,), the same memory.
    """
    for k in range(values.shape[0]):
        for i in range(values.shape[2]):
            ux = _wanted(last[1, _VX, i], last[0, _VX, i], gain)
            uy = _wanted(last[1, _VY, i], last[0, _VY, i], gain)
            # The component that is the smaller one: the other follows better from it.
            p, q, up, uq = (_VX, _VY, ux, uy) if abs(ux) <= abs(uy) else (_VY, _VX, uy, ux)
            scratch[0] = _known(_towards(last[0, p, i], up, gain, steps[k]))
            _transfer(packs, k, p, i, bits, scratch_bits[0], difference)
            up = _wanted(last[0, p, i], values[k, p, i], gain)
            if packs:
                taken[k, i] = _best_speed(
                    bits[k, q, i], last[0, q, i], up, uq, gain, steps[k], speeds[i],
                    scratch, scratch_bits,
                )  # fmt: skip
            scratch[0] = _predicted(taken[k, i], last[0, q, i], up, uq, gain, steps[k], speeds[i])
            _transfer(packs, k, q, i, bits, scratch_bits[0], difference)
            uq = _wanted(last[0, q, i], values[k, q, i], gain)
            speed = math.sqrt(up * up + uq * uq)
            if taken[k, i] == 0 and math.isfinite(speed):
                speeds[i, oldest[i]] = speed
                oldest[i] = (oldest[i] + 1) % SPEEDS
            for c in range(2):
                before, now = last[0, c + 2, i], values[k, c + 2, i]
                scratch[0] = _known(_moved(last[0, c, i], before, now, steps[k]))
                _transfer(packs, k, c, i, bits, scratch_bits[0], difference)
            for c in range(4):
                last[1, c, i] = last[0, c, i]
                last[0, c, i] = values[k, c, i]


@kernel
def _transfer(
    packs: bool,
    k: int,
    c: int,
    i: int,
    bits: NDArray[np.int64],
    predicted: int,
    difference: NDArray[np.int64],
) -> None:
    """Difference of a number's bits from those predicted, or the other way round.

    Small differences of either sign become small numbers.
    """
    if packs:
        off = bits[k, c, i] - predicted
        difference[c, k, i] = (off << 1) ^ (off >> 63)
    else:
        off = difference[c, k, i]
        bits[k, c, i] = predicted + (((off >> 1) & _POSITIVE) ^ -(off & 1))


@kernel
def _best_speed(
    bits: int,
    v: float,
    up: float,
    uq: float,
    gain: float,
    ticks: int,
    speeds: Array,
    scratch: Array,
    scratch_bits: NDArray[np.int64],
) -> int:
    """Which speed, from 1, predicts the larger component best; 0: none, but constant wishes."""
    best, least = 0, _POSITIVE
    for s in range(SPEEDS + 1):
        scratch[0] = _predicted(s, v, up, uq, gain, ticks, speeds)
        off = abs(bits - scratch_bits[0])
        if 0 <= off < least:
            best, least = s, off
    return best


@kernel
def _predicted(
    taken: int, v: float, up: float, uq: float, gain: float, ticks: int, speeds: Array
) -> float:
    """The larger component of the velocity.

    Args:
        taken: which speed is wanted, from 1; 0: what was wanted before, ``uq``.
        v: the component before.
        up: what is wanted of the smaller component.
    """
    if 1 <= taken <= SPEEDS:
        speed = speeds[taken - 1]
        rest = math.sqrt(max(speed * speed - up * up, 0.0))
        uq = -rest if uq < 0.0 else rest
    return _known(_towards(v, uq, gain, ticks))


@kernel
def _wanted(before: float, now: float, gain: float) -> float:
    """The velocity that was aimed at in a step; what there is where the step is unknown."""
    wanted = before + gain * (now - before)
    return wanted if math.isfinite(wanted) else now


@kernel
def _towards(v: float, wanted: float, gain: float, ticks: int) -> float:
    """Velocity one step later, added up tick by tick."""
    change = (wanted - v) / (gain * ticks)
    for _ in range(ticks):
        v += change
    return v


@kernel
def _moved(x: float, before: float, now: float, ticks: int) -> float:
    """Position one step later, while the velocity changes evenly, added up tick by tick."""
    change, v = (now - before) / ticks, before
    for _ in range(ticks):
        v += change
        x += v * TICK
    return x


@kernel
def _known(value: float) -> float:
    """0 for what is not finite: NaN has several spellings."""
    return value if math.isfinite(value) else 0.0
