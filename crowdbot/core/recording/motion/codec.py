"""Lossless compression of people's motion: differences from a prediction.

Where it is known among which velocities people choose, and where their goals are, the
choice determines the motion, unless
they are pushed. Else they are predicted from their two samples before. A person
who keeps the same target velocity u comes closer to it by the same share in each step,
``v + (u - v) / gain``; and a person who turns mostly keeps the target speed, so that of two
components of u the larger one follows from the smaller one. Positions follow from velocities tick
by tick, as the simulation adds them up. What is stored is the difference between the bits of a
number and those of its prediction: 0 for nine numbers of ten where choices are known.

For formulas see docs/reference/recording.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.motion.candidates import (
    CandidateGroup,
    CandidateTable,
    candidate_table,
)
from crowdbot.core.recording.motion.difference_bytes import EXACT, carry, mark_exact
from crowdbot.core.recording.motion.prediction import (
    SPEEDS,
    accelerate,
    acceleration,
    best_speed,
    chosen_candidate,
    known,
    moved,
    predicted,
    prefer,
    target_velocity,
    towards,
)
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.ticks import TICKS_PER_SECOND
from crowdbot.core.types.arrays import Array

#: Steps in which a person would reach the target velocity, one of which is chosen.
GAINS = (8.0, 4.0, 2.0, 16.0, 1.0)
_SAMPLES_FOR_GAIN = 4
#: Longer steps, or fractional ticks, are predicted as one tick.
_LONGEST = TICKS_PER_SECOND
_POSITIVE = 2**63 - 1
#: Entries of the numbers (4, M) of one sample.
_VX, _VY = 2, 3
#: Prediction numbers from here on mean a candidate, by its distance from the last one in order.
_CHOICE = SPEEDS + 1
#: For each gain, the share of a change of velocity that is left in the next step.
_LEFT = np.array([(gain - 1.0) / gain for gain in GAINS])[:, np.newaxis, np.newaxis, np.newaxis]


class Packed(NamedTuple):
    """Compressed samples of people.

    Attributes:
        gain: the chosen gain.
        data: bytes: the prediction used, one byte per person and sample; then, for each of x, y,
            vx, vy, the eight bytes of all differences, lowest bytes first, except where all four
            are 0.
    """

    gain: float
    data: bytes


class _Samples(NamedTuple):
    """Samples being packed or unpacked, for the compiled loops.

    Attributes:
        packs: True to pack, False to unpack.
        values, bits: (K, 4, M), the same memory.
        scratch, scratch_bits: (1,), the same memory.
        taken: (K, M) predictions used.
        difference: (4, K, M) differences of the bits.
    """

    packs: bool
    values: Array
    bits: NDArray[np.int64]
    scratch: Array
    scratch_bits: NDArray[np.int64]
    taken: NDArray[np.uint8]
    difference: NDArray[np.int64]


class _PreviousState(NamedTuple):
    """The state from earlier samples, updated in place.

    Attributes:
        last: (2, 4, M) the sample before, and the one before that.
        speeds: (M, SPEEDS) the latest target speeds, m/s.
        oldest: (M,) which of them is replaced next.
    """

    last: Array
    speeds: Array
    oldest: NDArray[np.int64]


class MotionCodec:
    """Compresses or decompresses the samples of one recording, in order.

    Args:
        people: how many there are.
        choosers: those whose candidates are known; no person is in two groups.
    """

    def __init__(self, people: int, choosers: Sequence[CandidateGroup] = ()) -> None:
        self._people = people
        self._candidates = candidate_table(people, choosers)
        self._choice = np.zeros(people, np.int64)  # the last candidate taken
        self._ahead, self._pull = np.zeros((2, people)), np.zeros((2, people))  # see `_code`
        self._followed = np.zeros((4, people))
        self._last_t = math.nan
        self._last = np.full((2, 4, people), np.nan)  # the two previous samples
        self._speeds = np.zeros((people, SPEEDS))
        self._oldest = np.zeros(people, np.int64)

    def pack(self, t: Array, motion: Array, goals: Array | None = None) -> Packed:
        """Pack samples.

        Args:
            t: (K,) times, s.
            motion: (K, 4, M) x, y, vx, vy; NaN where a person is absent.
            goals: (K, 2, M) to which people went in the step before each sample; None: not known.
        """
        values = np.ascontiguousarray(motion, np.float64)
        gain, taken, difference = self._best_gain(values), *self._space(len(t))
        self._code(t, values, goals, gain, taken, difference, packs=True)
        data = np.empty(taken.size + 32 * mark_exact(taken, difference), np.uint8)
        carry(True, taken, difference, data)
        return Packed(gain, data.tobytes())

    def unpack(self, t: Array, packed: Packed, goals: Array | None = None) -> Array:
        """Return the exact samples (K, 4, M); ``goals`` must be as for `pack`.

        Raises:
            ValueError: the data do not match the number of samples and people.
        """
        values = np.zeros((len(t), 4, self._people))
        taken, difference = self._space(len(t))
        data = np.frombuffer(packed.data, np.uint8).copy()  # as `carry` is compiled
        marks = data[: taken.size]
        rest = np.count_nonzero((marks & EXACT) == 0)
        if len(marks) != taken.size or data.size != taken.size + 32 * rest:
            raise ValueError(f"{data.size} bytes of {len(t)} samples of {self._people} people")
        carry(False, taken, difference, data)
        self._code(t, values, goals, packed.gain, taken, difference, packs=False)
        return values

    def _code(
        self,
        t: Array,
        values: Array,
        goals: Array | None,
        gain: float,
        taken: NDArray[np.uint8],
        difference: NDArray[np.int64],
        *,
        packs: bool,
    ) -> None:
        scratch = np.zeros(1)
        given = np.full((len(t), 2, self._people), np.nan) if goals is None else goals
        _code(
            packs, values, values.view(np.int64), self._steps(t), gain, self._last, self._speeds,
            self._oldest, self._candidates, given, self._choice, self._ahead, self._pull,
            self._followed, scratch, scratch.view(np.int64), taken, difference,
        )  # fmt: skip

    def _space(self, samples: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
        """Return arrays for the predictions used (K, M), and differences (4, K, M)."""
        taken = np.zeros((samples, self._people), np.uint8)
        return taken, np.zeros((4, samples, self._people), np.int64)

    def _steps(self, t: Array) -> NDArray[np.int64]:
        """Return (K,) ticks since the last sample; 1 if not a whole number."""
        gaps = (t - np.concatenate([[self._last_t], t[:-1]])[: len(t)]) * TICKS_PER_SECOND
        self._last_t = float(t[-1]) if len(t) else self._last_t
        whole = (gaps >= 1.0) & (gaps <= _LONGEST) & (gaps == np.rint(gaps))
        return np.where(whole, gaps, 1.0).astype(np.int64)

    def _best_gain(self, values: Array) -> float:
        """Return the gain that predicts most velocities best."""
        before = np.concatenate([self._last[::-1, _VX:], values[:_SAMPLES_FOR_GAIN, _VX:]])
        with np.errstate(all="ignore"):
            change = np.diff(before, axis=0)
            off = np.abs(change[1:] - change[:-1] * _LEFT) + 1e-18
            cost = np.nansum(np.log2(off).reshape(len(GAINS), -1), axis=1)
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
    candidates: CandidateTable,
    goals: Array,
    choice: NDArray[np.int64],
    ahead: Array,
    pull: Array,
    followed: Array,
    scratch: Array,
    scratch_bits: NDArray[np.int64],
    taken: NDArray[np.uint8],
    difference: NDArray[np.int64],
) -> None:
    """Fill ``taken`` and ``difference`` from ``values``, or the reverse.

    One function for both directions, so that predictions are identical.

    Args:
        packs to difference: fields of `_Samples` and `_PreviousState`.
        steps: (K,) ticks since the last sample.
        goals: (K, 2, M).
        choice: (M,) the last candidate taken, updated.
        ahead, pull, followed: (2, M), (2, M), (4, M) scratch: preferred velocities, accelerations
            towards candidates, and the resulting motion.
    """
    samples = _Samples(packs, values, bits, scratch, scratch_bits, taken, difference)
    past = _PreviousState(last, speeds, oldest)
    chooses = candidates.unit.shape[0] > 0
    for k in range(values.shape[0]):
        if chooses:  # all people at once, which vectorises
            prefer(candidates, last[0], goals[k], ahead)
            _choose(samples, k, steps[k], last[0], candidates, ahead, choice, pull)
            accelerate(last[0], pull, steps[k], followed)
        for i in range(values.shape[2]):
            follows = False
            if taken[k, i] >= _CHOICE and candidates.choices[i] > 0:
                follows = _follow(samples, k, i, followed[_VX, i], followed[_VY, i])
            else:
                _extrapolate(samples, past, k, i, steps[k], gain)
            for c in range(2):
                scratch[0] = followed[c, i]
                if not follows:
                    before, now = last[0, c + 2, i], values[k, c + 2, i]
                    scratch[0] = known(moved(last[0, c, i], before, now, steps[k]))
                _transfer(samples, k, c, i)
            for c in range(4):
                last[1, c, i] = last[0, c, i]
                last[0, c, i] = values[k, c, i]


@inline_kernel
def _choose(
    samples: _Samples,
    k: int,
    ticks: int,
    before: Array,
    candidates: CandidateTable,
    ahead: Array,
    choice: NDArray[np.int64],
    pull: Array,
) -> None:
    """Find the candidates that people take in sample k, if any, and the accelerations to them."""
    taken = samples.taken
    for i in range(choice.shape[0]):
        count = candidates.choices[i]
        pull[0, i] = pull[1, i] = 0.0
        if samples.packs:
            c = chosen_candidate(candidates, i, before, samples.values[k], ahead, ticks, choice[i])
            if c >= 0:
                taken[k, i] = _CHOICE + (c - choice[i]) % count
        if taken[k, i] >= _CHOICE and count > 0:
            choice[i] = (choice[i] + taken[k, i] - _CHOICE) % count
            pull[0, i], pull[1, i] = acceleration(
                candidates, i, choice[i], ahead[0, i], ahead[1, i], before
            )


@inline_kernel
def _follow(samples: _Samples, k: int, i: int, vx: float, vy: float) -> bool:
    """Predict velocities from an acceleration; return True if they are exact."""
    samples.scratch[0] = vx
    _transfer(samples, k, _VX, i)
    samples.scratch[0] = vy
    _transfer(samples, k, _VY, i)
    difference = samples.difference
    return bool(difference[_VX, k, i] == 0 and difference[_VY, k, i] == 0)


@inline_kernel
def _extrapolate(
    samples: _Samples, past: _PreviousState, k: int, i: int, ticks: int, gain: float
) -> None:
    """Predict velocities from those of the two previous samples."""
    last, speeds, scratch = past.last, past.speeds[i], samples.scratch
    values, taken = samples.values, samples.taken
    ux = target_velocity(last[1, _VX, i], last[0, _VX, i], gain)
    uy = target_velocity(last[1, _VY, i], last[0, _VY, i], gain)
    # The component that is the smaller one: the other follows better from it.
    p, q, up, uq = (_VX, _VY, ux, uy) if abs(ux) <= abs(uy) else (_VY, _VX, uy, ux)
    scratch[0] = known(towards(last[0, p, i], up, gain, ticks))
    _transfer(samples, k, p, i)
    up = target_velocity(last[0, p, i], values[k, p, i], gain)
    if samples.packs:
        taken[k, i] = best_speed(
            samples.bits[k, q, i], last[0, q, i], up, uq, gain, ticks, speeds, scratch,
            samples.scratch_bits,
        )  # fmt: skip
    scratch[0] = predicted(taken[k, i], last[0, q, i], up, uq, gain, ticks, speeds)
    _transfer(samples, k, q, i)
    uq = target_velocity(last[0, q, i], values[k, q, i], gain)
    speed = math.sqrt(up * up + uq * uq)
    if taken[k, i] == 0 and math.isfinite(speed):
        speeds[past.oldest[i]] = speed
        past.oldest[i] = (past.oldest[i] + 1) % SPEEDS


@inline_kernel
def _transfer(samples: _Samples, k: int, c: int, i: int) -> None:
    """Store the difference of a number's bits from those in scratch, or the reverse.

    Small differences of either sign are stored as small numbers.
    """
    bits, predicted_bits = samples.bits, samples.scratch_bits[0]
    if samples.packs:
        off = bits[k, c, i] - predicted_bits
        samples.difference[c, k, i] = (off << 1) ^ (off >> 63)
    else:
        off = samples.difference[c, k, i]
        bits[k, c, i] = predicted_bits + (((off >> 1) & _POSITIVE) ^ -(off & 1))
