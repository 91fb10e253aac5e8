"""Jumps of robot or people: steps much faster than the others, by corrections or reused ids."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crowdbot.core.types.arrays import Array, Mask

#: A jump is longer than this, m, and this many times faster than nearly all steps, at least m/s.
_LEAP, _TIMES, _LEAST = 0.5, 3.0, 1.5
_NEARLY_ALL = 95.0  # %
#: Steps that are needed to know how fast a body is.
_FEW = 5
#: A faster step is a teleport, unless a metric's `jump_speed` says otherwise, m/s.
_TELEPORT = 10.0


def findings(
    name: str, t: Array, x: Array, y: Array, recorded: Mask | None = None
) -> Iterator[str]:
    """Yield a sentence on the steps in which bodies jump.

    Args:
        name: the robot or people, for the sentence.
        t: times (N,), s.
        x, y: places (N,) or (N, M), m; NaN where absent.
        recorded: steps (N-1, M) that were recorded as teleports, which are none of these.
    """
    steps, speeds = steps_and_speeds(t, x, y)
    absent = nowhere(x, y)
    known = np.isfinite(speeds) & (absent[1:] == absent[:-1])  # places left out are told by others
    if recorded is not None:
        known &= ~recorded
    moving = speeds[known & (steps > 0.0)]
    if len(moving) < _FEW:
        return
    usual = float(np.percentile(moving, _NEARLY_ALL)) if len(moving) > 40 else _second(moving)
    jumps = known & (steps > _LEAP) & (speeds > max(_TIMES * usual, _LEAST))
    if not jumps.any():
        return
    k = np.unravel_index(np.argmax(np.where(jumps, steps, 0.0)), jumps.shape)
    count = np.count_nonzero(jumps)
    seen = f"{name}: {count} jump{'s' if count > 1 else ''}"
    where = f"{'the longest ' if count > 1 else ''}of {steps[k]:.3g} m at t = {t[k[0] + 1]:.6g} s"
    yield f"{seen}, {where}: {_meaning(name)} {_scored(speeds[jumps])}"


def steps_and_speeds(t: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Return the steps between samples, m, and their speeds, m/s; NaN where a place is missing.

    Args:
        t: times (N,), s.
        x, y: places (N,) or (N, M), m.
    """
    with np.errstate(invalid="ignore"):
        steps = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0))
        return steps, steps / np.diff(t).reshape(-1, *([1] * (x.ndim - 1)))


def nowhere(x: Array, y: Array) -> Mask:
    """Return a mask of places that stand for missing ones: x = y = 0, -1, or an integer beyond 99.

    Args:
        x, y: places of one shape, m.
    """
    found: Mask = (x == y) & ((x == 0.0) | (x == -1.0) | ((np.abs(x) >= 99.0) & (x == np.round(x))))
    return found


def _second(moving: Array) -> float:
    """Return the second-highest speed of a few steps."""
    return float(np.sort(moving)[-2])


def _meaning(name: str) -> str:
    return "a corrected place?" if name == "the robot" else "an id that was used again?"


def _scored(speeds: Array) -> str:
    """Describe how metrics treat jumps of such speeds, m/s."""
    slow = np.count_nonzero(speeds <= _TELEPORT)
    if not slow:
        return "Metrics take steps faster than 10 m/s (jump_speed) for teleports and leave them out"
    counted = "Metrics count it" if len(speeds) == 1 else f"Metrics count {slow} of them"
    return (
        f"{counted} as motion, since only steps faster than 10 m/s (jump_speed) are teleports: "
        "a smaller jump_speed leaves out more"
    )
