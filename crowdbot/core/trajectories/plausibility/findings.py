"""Detect implausible recordings: wrong units, headings in degrees, mismatched frames.

Each finding states the evidence and the likely cause; nothing is corrected.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import crowdbot.core.trajectories.plausibility.jumps as jumps
import crowdbot.core.trajectories.plausibility.times as times
import crowdbot.core.trajectories.plausibility.units as units
from crowdbot.core.trajectories.plausibility.times import PERSON_SPEED, USUAL
from crowdbot.core.types.arrays import Array

#: `crowdbot.core.trajectories.trajectories`, which imports an importer of this file.
Trajectories = Any

#: Median speed that no robot exceeds, m/s.
ROBOT_SPEED = 20.0
#: Below this speed a body has no direction of motion, m/s.
_MOVING = 0.05
#: Number of samples needed for a finding, and number that is enough where all are compared.
_FEW, _ENOUGH = 5, 500
_UNITS = {"positions in millimetres": 1000, "positions in centimetres": 100}
_MINUTES, _FASTEST = {"times in minutes": 60}, 0.005  # s between samples, rarely less
_AGREED, _NEARLY_ALL = 0.8, 0.95  # shares of samples in which headings agree with the motion
_HEADINGS = 0.7  # rad; largest deviation of an agreeing heading
_LEAP = 0.5  # m; a step from exactly (0, 0) that is longer began elsewhere
#: A recorded speed is wrong outside these multiples of the way of a second; units that explain it.
_TOO_SLOW, _TOO_FAST = 0.5, 3.0
_SPEEDS = {"km/h": 3.6, "cm/s": 100.0, "mm/s": 1000.0}
_INEXACT = 0.1  # rad; usual deviation of a measured heading from the motion
_NOT_FILLED_IN = 0.3  # rad; larger deviation of a heading that never changes


def implausible(run: Trajectories) -> list[str]:
    """Return findings with evidence, as sentences; empty for a plausible run."""
    tracks: list[tuple[str, Array, Array, float]] = []
    if run.robot is not None:
        tracks.append(("the robot", run.robot.x, run.robot.y, ROBOT_SPEED))
    if run.agents is not None:
        tracks.append(("people", run.agents.x, run.agents.y, PERSON_SPEED))
    found = list(_times(run.t, tracks))
    for name, x, y, limit in tracks:
        found += _speeds(name, run.t, x, y, limit)
    if not found:
        found += [f for name, x, y, _ in tracks for f in units.creeping(run.t, name, x, y)]
    found += [*units.bodies(run), *units.turning(run)]
    found += _headings(run)
    found += _placeholders(run)
    found += _jumps(run)
    found += list(_recorded_velocities(run)) or list(_recorded_speeds(run))
    return found or list(_apart(run))


def _times(t: Array, tracks: list[tuple[str, Array, Array, float]]) -> Iterator[str]:
    if len(t) < _FEW:
        return
    medians = {name: _median_speed(t, x, y) for name, x, y, _ in tracks}
    yield from times.findings(t, {w: v for w, v in medians.items() if v is not None})


def _speeds(name: str, t: Array, x: Array, y: Array, limit: float) -> Iterator[str]:
    median = _median_speed(t, x, y)
    if median is None or median <= limit:
        return
    nearest = _speed_by_nearness(t, x, y) if x.ndim > 1 and x.shape[1] > 1 else None
    if nearest is not None and nearest <= limit:
        yield (
            f"{name}: median speed {median:.3g} m/s, but {nearest:.3g} m/s if each is the one "
            "nearest to the place of the sample before: ids that change from sample to sample?"
        )
        return
    whole = np.all(x == np.round(x), where=np.isfinite(x))
    units = {**_UNITS, **(_MINUTES if np.median(np.diff(t)) < _FASTEST else {})}
    unit, factor = min(units.items(), key=lambda item: abs(np.log(median / item[1] / USUAL)))
    yield (
        f"{name}: median speed {median:.3g} m/s: {unit}{', or in pixels' if whole else ''}? "
        f"Divided by {factor} it would be {median / factor:.3g} m/s"
    )


def _median_speed(t: Array, x: Array, y: Array) -> float | None:
    """Return the median speed of moving bodies, m/s; None if too few move."""
    steps, speeds = jumps.steps_and_speeds(t, x, y)
    speeds = speeds[np.isfinite(speeds) & (steps > 0.0)]
    return float(np.median(speeds)) if len(speeds) >= _FEW else None


def _speed_by_nearness(t: Array, x: Array, y: Array) -> float | None:
    """Return the median speed of people (T, N) if each was the nearest one of the sample before."""
    t, x, y = t[:_ENOUGH], x[:_ENOUGH], y[:_ENOUGH]
    at, best = np.stack([x, y], axis=-1), np.full(x[1:].shape, np.inf)
    for other in range(x.shape[1]):
        step = np.hypot(*(at[1:] - at[:-1, other : other + 1]).transpose(2, 0, 1))
        best = np.fmin(best, step)
    speeds = (best / np.diff(t)[:, np.newaxis])[np.isfinite(best) & (best > 0.0)]
    return float(np.median(speeds)) if len(speeds) >= _FEW else None


def _jumps(run: Trajectories) -> Iterator[str]:
    if run.robot is not None:
        yield from jumps.findings("the robot", run.t, run.robot.x, run.robot.y)
    if run.agents is not None:
        yield from jumps.findings("people", run.t, run.agents.x, run.agents.y, run.agents.jump)


def _placeholders(run: Trajectories) -> Iterator[str]:
    """Check for people at exactly (0, 0) or (-1, -1) who then are suddenly elsewhere."""
    if run.agents is None:
        return
    x, y = run.agents.x, run.agents.y
    nowhere = jumps.nowhere(x, y)
    with np.errstate(invalid="ignore"):
        steps = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0))
        leaps = (nowhere[1:] != nowhere[:-1]) & (steps > PERSON_SPEED * np.diff(run.t)[:, None])
    leaping = np.flatnonzero((leaps & (steps > _LEAP)).any(axis=0))
    if len(leaping):
        ids = ", ".join(str(i) for i in run.agents.id[leaping[:5]])
        values = np.unique(x[:, leaping][nowhere[:, leaping]])
        at = " or ".join(f"({value:g}, {value:g})" for value in values[:3])
        yield (
            f"people: in {np.count_nonzero(nowhere[:, leaping])} samples {len(leaping)} of them "
            f"({ids}) stand at exactly {at}, and suddenly elsewhere: leave cells without a place "
            "empty"
        )


def _headings(run: Trajectories) -> Iterator[str]:
    """Check that the heading agrees with the motion, forwards or backwards."""
    robot = run.robot
    if robot is None or len(run.t) < _FEW or robot.vx is not None:
        return
    with np.errstate(invalid="ignore"):
        vx, vy = np.gradient(robot.x, run.t), np.gradient(robot.y, run.t)
        moving = (np.hypot(vx, vy) > _MOVING) & np.isfinite(robot.theta)
    if np.count_nonzero(moving) < _FEW:
        return
    motion, theta = np.arctan2(vy, vx)[moving], robot.theta[moving]
    as_radians = _agreement(motion, theta)
    if as_radians >= _AGREED:
        yield from list(_degrees(motion, theta)) or _constant(motion, theta)
        return
    seen = f"the heading agrees with the motion in {100 * as_radians:.0f} % of the samples"
    others = {
        "taken as degrees": np.radians(theta),
        "turned by 90 degrees": theta + 0.5 * np.pi,
        "turned by -90 degrees": theta - 0.5 * np.pi,
        "with x and y exchanged": 0.5 * np.pi - theta,
        "turning the other way": -theta,
    }
    best = max(others, key=lambda name: _agreement(motion, others[name]))
    agreed = _agreement(motion, others[best])
    # On curved paths a wrong heading agrees in half of the samples by chance: then the other
    # reading must agree nearly everywhere.
    if agreed > max(_AGREED, min(2.0 * as_radians, _NEARLY_ALL)):
        seen = f"{seen}; {best}, in {100 * agreed:.0f} %"
        yield f"the robot: {seen}: theta is in radians, from x to y"
    elif as_radians < 0.5 and float(np.max(np.abs(theta))) > 4.0 * np.pi:
        yield f"the robot: {seen}, and reaches {np.max(np.abs(theta)):.0f} rad: degrees?"
    else:
        yield from _constant(motion, theta)


def _constant(motion: Array, theta: Array) -> Iterator[str]:
    """Check a heading that never changes: a column that was not filled in agrees by chance only."""
    off = float(np.median(_errors(motion, theta)))
    if off > _NOT_FILLED_IN and np.ptp(theta) == 0.0:
        yield (
            f"the robot: the heading is {theta[0]:g} rad in all samples, {off:.2g} rad off the "
            "motion (median): was it never filled in? Left out, the heading is the "
            "direction of motion"
        )


def _degrees(motion: Array, theta: Array) -> Iterator[str]:
    """Check headings that agree by chance: as degrees they would agree much better."""
    radians, degrees = (float(np.median(_errors(motion, a))) for a in (theta, np.radians(theta)))
    if radians > _INEXACT and degrees < 0.25 * radians and np.max(np.abs(theta)) > 1.0:
        yield (
            f"the robot: the heading is {radians:.2g} rad off the motion (median); taken as "
            f"degrees, {degrees:.2g} rad: theta is in radians, from x to y"
        )


def _errors(motion: Array, theta: Array) -> Array:
    """Return deviations of headings from the motion, forwards or backwards, rad."""
    return np.abs(np.remainder(motion - theta + 0.5 * np.pi, np.pi) - 0.5 * np.pi)


def _agreement(motion: Array, theta: Array) -> float:
    """Return the share of samples in which a body moves along its heading, or straight back."""
    return float(np.mean(_errors(motion, theta) < _HEADINGS))


def _recorded_velocities(run: Trajectories) -> Iterator[str]:
    """Check that velocities agree with the change of positions."""
    for subject, track in (("the robot", run.robot), ("people", run.agents)):
        velocity = None if track is None else _velocity(track)
        if velocity is None or len(run.t) < _FEW:
            continue
        with np.errstate(invalid="ignore"):
            x, y = (np.gradient(p, run.t, axis=0) for p in (track.x, track.y))
            known = np.isfinite(x + y + velocity[0] + velocity[1]) & (np.hypot(x, y) > _MOVING)
        if np.count_nonzero(known) < _FEW:
            continue
        x, y, vx, vy = x[known], y[known], velocity[0][known], velocity[1][known]
        speed, off = float(np.median(np.hypot(x, y))), _off(x, y, vx, vy)
        if off <= 0.5 * speed:
            continue
        seen = (
            f"{subject}: velocities differ from the change of positions by {off:.3g} m/s (median)"
        )
        if track.vx is not None and (swapped := _off(x, y, vy, vx)) < 0.25 * off:
            yield f"{seen}; with x and y exchanged by {swapped:.3g} m/s"
        elif subject == "the robot" and run.robot is not None:
            c, s = np.cos(run.robot.theta[known]), np.sin(run.robot.theta[known])
            turned = {
                "the robot's own frame": _off(x, y, c * vx - s * vy, s * vx + c * vy),
                "the world's frame": _off(x, y, c * vx + s * vy, c * vy - s * vx),
            }
            frame = min(list(turned)[track.vx is None :], key=lambda name: turned[name])
            if turned[frame] < 0.25 * off:
                yield f"{seen}; taken in {frame} by {turned[frame]:.3g} m/s"


def _velocity(track: Any) -> tuple[Array, Array] | None:
    """Return recorded velocities in the world's frame, m/s; None: there are none."""
    if track.vx is not None and track.vy is not None:
        return track.vx, track.vy
    v = getattr(track, "v", None)
    return None if v is None else (v * np.cos(track.theta), v * np.sin(track.theta))


def _off(x: Array, y: Array, vx: Array, vy: Array) -> float:
    return float(np.median(np.hypot(x - vx, y - vy)))


def _recorded_speeds(run: Trajectories) -> Iterator[str]:
    """Check that speeds agree with the distance moved in a second: missing values, km/h, mm/s."""
    if len(run.t) < _FEW:
        return
    for name, track in (("the robot", run.robot), ("people", run.agents)):
        velocity = None if track is None else _velocity(track)
        if velocity is None:
            continue
        ways, recorded = _of_a_second(run.t, track.x, track.y, np.hypot(*velocity))
        known = np.isfinite(ways + recorded) & (ways > 2.0 * _MOVING)
        if np.count_nonzero(known) < _FEW:
            continue
        way, recorded_speed = float(np.median(ways[known])), float(np.median(recorded[known]))
        if not _TOO_SLOW * way <= recorded_speed <= _TOO_FAST * way:
            unit = next(
                (u for u, f in _SPEEDS.items() if abs(recorded_speed / way / f - 1.0) < 0.1), ""
            )
            yield (
                f"{name}: the recorded speed is {recorded_speed:.3g} m/s (median), the way of a "
                f"second {way:.3g} m{f': {unit}?' if unit else ''}; velocities that are left out "
                "are derived from positions"
            )


def _of_a_second(t: Array, x: Array, y: Array, speed: Array) -> tuple[Array, Array]:
    """Return net displacements over one second, in m/s, and the mean recorded speeds in it, m/s."""
    steps = min(max(1, round(1.0 / float(np.median(np.diff(t))))), len(t) - 1)
    dt = (t[steps:] - t[:-steps]).reshape(-1, *([1] * (x.ndim - 1)))
    ways = np.hypot(x[steps:] - x[:-steps], y[steps:] - y[:-steps]) / dt
    total = np.cumsum(speed, axis=0)
    return ways, (total[steps:] - total[:-steps]) / steps


def _apart(run: Trajectories) -> Iterator[str]:
    """Check that robot and people are in the same place; skipped if x and y look swapped in one."""
    if run.robot is None or run.agents is None or not run.agents.x.size:
        return
    nearest = _nearest(run, run.agents.x, run.agents.y)
    if not nearest > 20.0:
        return
    seen = f"the nearest person is never nearer to the robot than {nearest:.3g} m"
    swapped = _nearest(run, run.agents.y, run.agents.x)
    if swapped < 0.1 * nearest:
        yield f"{seen}; with x and y of people exchanged {swapped:.3g} m: another frame?"
    else:
        yield f"{seen}: do robot and people have the same frame and units?"


def _nearest(run: Trajectories, x: Array, y: Array) -> float:
    assert run.robot is not None
    with np.errstate(invalid="ignore"):
        gaps = np.hypot(x - run.robot.x[:, None], y - run.robot.y[:, None])
    gaps = gaps[np.isfinite(gaps)]
    return float(gaps.min()) if len(gaps) else 0.0
