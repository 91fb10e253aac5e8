"""Tracks: positions of people, four times a second, in a corridor along x."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.realism.bins import DT, RATE, WINDOW
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

T = TypeVar("T")

#: Share of a recording dropped at its start and its end, when people come and go.
_MARGIN = 0.15
#: From this share of people in the opposite direction, a flow is a counterflow.
_MINORITY = 0.1
#: Distance that the outermost centres keep from the walls, m.
_BODY = 0.2
#: Outermost share of positions that is ignored for the corridor's width.
_TAIL = 0.005
#: Longer recordings show corridors without visible ends, m.
_LONG = 20.0


class NothingToCompareError(InputError):
    """A recording has no walking people, or is too short."""


def of_files(files: Sequence[Path], read: Callable[[Path], list[T]]) -> tuple[list[T], list[str]]:
    """Return all that is read from files, and why others have nothing to compare.

    Raises:
        InputError: a file cannot be read, or all have nothing to compare.
    """
    parts: list[T] = []
    without: list[str] = []
    for file in files:
        try:
            parts += read(file)
        except NothingToCompareError as error:
            without.append(str(error))
    if not parts:
        raise InputError(without[0])
    return parts, without


@dataclass(frozen=True, slots=True, kw_only=True)
class CorridorTracks:
    """People in a corridor along x, at 4 Hz.

    Attributes:
        position: (T, N, 2) m, within the period; NaN where absent.
        way: (T, N, 2) m, as walked: without jumps at the period's border.
        width: width of the corridor, m.
        period: length of a corridor without ends, m; 0 for one with ends.
        windows: (W, 2) start and end along x in which people are compared, m.
        first, last: compared frames: from the first to before the last.
        radius: radius of the bodies, m; 0 if unknown.
    """

    position: Array
    way: Array
    width: float
    period: float
    windows: Array
    first: int
    last: int
    radius: float = 0.0

    @property
    def direction(self) -> Array:
        """Return (N,) 1 for people who walk along x, -1 against it, 0 if they do not move."""
        step = np.diff(self.way[..., 0], axis=0)
        known = np.isfinite(step)
        return np.asarray(np.sign(np.where(known, step, 0.0).sum(axis=0)))

    @property
    def flow(self) -> str:
        """Return ``counter`` if at least a tenth walks in the other direction, else ``uni``."""
        way = self.direction[self.direction != 0.0]
        minority = min(np.mean(way > 0), np.mean(way < 0)) if len(way) else 0.0
        return "counter" if minority >= _MINORITY else "uni"


def tracks_of(
    run: Trajectories, name: str, *, width: float | None = None, centre: bool = False
) -> CorridorTracks:
    """Convert trajectories of any direction and rate to tracks.

    The corridor lies along the axis on which people walk. By default its width is that of their
    positions.

    Args:
        run: trajectories with people.
        name: file name for messages.
        width: width of the corridor, m.
        centre: compare only one window around x = 0, for recordings with a small camera view.

    Raises:
        NothingToCompareError: no one walks, or the run is too short.
    """
    if run.agents is None or not np.any(np.isfinite(run.agents.x)):
        raise NothingToCompareError(f"{name}: there are no people in it")
    at = _at_rate(run.t, run.agents.x, run.agents.y, run.agents.jump)
    at = _along_x(at)
    frames = len(at)
    first, last = int(_MARGIN * frames), int((1.0 - _MARGIN) * frames)
    if last - first < 8:
        raise NothingToCompareError(
            f"{name}: {frames / RATE:.1f} s are too short; 3 s and more can be compared"
        )
    windows = np.array([[-WINDOW / 2, WINDOW / 2]]) if centre else _windows(at[..., 0])
    return CorridorTracks(
        position=at,
        way=at,
        width=float(width or _width(at, windows)),
        period=0.0,
        windows=windows,
        first=first,
        last=last,
        radius=float(np.median(run.agents.radius)) if len(run.agents.radius) else 0.0,
    )


def _at_rate(t: Array, x: Array, y: Array, jump: NDArray[np.bool_] | None) -> Array:
    """Return (T, N, 2) at 4 Hz: means over a quarter of a second, or interpolated points."""
    at = np.stack([x, y], axis=-1)
    if len(t) < 2:
        return at
    if np.median(np.diff(t)) > 0.6 * DT:
        return _between(t, at)
    frame = np.floor((t - t[0]) * RATE + 1e-9).astype(np.int64)
    out = np.full((int(frame[-1]) + 1, *at.shape[1:]), np.nan)
    jumped = np.zeros(at.shape[:2], np.bool_)
    if jump is not None:
        jumped[1:] = jump
    starts = np.searchsorted(frame, np.arange(len(out)))
    ends = np.append(starts[1:], len(t))
    for k, (a, b) in enumerate(zip(starts, ends, strict=True)):
        if b > a:
            mean = at[a:b].mean(axis=0)
            mean[jumped[a + 1 : b].any(axis=0)] = np.nan
            out[k] = mean
    return out


def _between(t: Array, at: Array) -> Array:
    """Interpolate linearly between samples; NaN if a neighbouring sample is missing."""
    when = np.arange(t[0], t[-1] + 1e-9, DT)
    after = np.clip(np.searchsorted(t, when, side="left"), 1, len(t) - 1)
    share = ((when - t[after - 1]) / (t[after] - t[after - 1]))[:, np.newaxis, np.newaxis]
    before = np.where(share < 1.0, at[after - 1], at[after])
    return np.asarray(np.where(share > 0.0, before + share * (at[after] - before), before))


def _along_x(at: Array) -> Array:
    """Rotate the positions so that people walk along x, in either direction."""
    step = np.diff(at, axis=0)
    step = step[np.isfinite(step).all(axis=-1)]
    size = np.hypot(step[:, 0], step[:, 1])
    step = step[size < 4.0 * DT]  # jumps
    twice = np.sum((step[:, 0] + 1j * step[:, 1]) ** 2)
    angle = 0.5 * float(np.angle(twice))
    if abs(angle) < 0.02:  # the corridor already lies along x
        return at
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(at @ np.array([[c, -s], [s, c]]))


def _windows(x: Array) -> Array:
    """Return windows of 4 m: side by side in a long corridor, one in the middle of a short one.

    Cameras see people in the middle with all their neighbours, and the corridor often ends beyond.
    The middle is at 0 if people walk there, as in most experiments.
    """
    known = x[np.isfinite(x)]
    low, high = np.quantile(known, [_TAIL, 1.0 - _TAIL])
    count = max(1, int((high - low - 2.0 * WINDOW) // WINDOW)) if high - low > _LONG else 1
    middle = 0.5 * (low + high)
    if count == 1 and abs(middle) < 0.25 * (high - low):
        middle = 0.0
    begin = middle - 0.5 * count * WINDOW
    return np.array([[begin + k * WINDOW, begin + (k + 1) * WINDOW] for k in range(count)])


def _width(at: Array, windows: Array) -> float:
    """Return the width of people's positions in the windows, plus their distance from walls, m."""
    x, y = at[..., 0], at[..., 1]
    inside = (x >= windows[0, 0]) & (x < windows[-1, 1])
    if not np.any(inside):
        inside = np.isfinite(x)
    low, high = np.quantile(y[inside], [_TAIL, 1.0 - _TAIL])
    return float(high - low) + 2.0 * _BODY
