"""The robot and each person as a pair of moving bodies: gaps, time to contact, contacts.

People are discs; the robot is a disc, or has a footprint. N samples, M people; world frame, SI
units. NaN means absent or unknown. Results are cached per run.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.geometry.footprint import Footprint, into_frame
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.trajectories.footprint_of_run import footprint_of
from crowdbot.core.trajectories.preprocess import (
    agent_velocities,
    inf_to_nan,
    robot_velocity,
    valid_agent_steps,
    valid_robot_steps,
    wrap,
)
from crowdbot.core.trajectories.tracks import AgentTracks, RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Mask

#: Margin within which a comparison without roots does not decide: far more than rounding.
_CLEARLY = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Encounter:
    """All people relative to the robot.

    Attributes:
        t: (N,) sample times, s.
        px, py: (N, M) position of each person minus the robot's, m.
        reach: (M,) sum of both radii, m; with a footprint, only the person's.
        distance: (N, M) distance between centres, m.
        gap: (N, M) distance between surfaces, m; negative in contact.
        valid: (N-1, M) steps on which both bodies moved continuously.
        footprint: outline of a robot that is not a disc.
        theta: (N,) heading of the robot, rad.
    """

    t: Array
    px: Array
    py: Array
    reach: Array
    distance: Array
    gap: Array
    valid: Mask
    footprint: Footprint | None
    theta: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Contacts:
    """Starts of contacts: time (s), column of the person, sample before the onset; (K,)."""

    time: Array
    agent: NDArray[np.int64]
    sample: NDArray[np.int64]


def robot_of(run: Trajectories) -> RobotTrack:
    """Return the robot of a run, which must have one."""
    assert run.robot is not None
    return run.robot


def people(run: Trajectories) -> AgentTracks:
    """Return all people in a run; M = 0 in a run without people."""
    if run.agents is not None:
        return run.agents
    nowhere, none = np.empty((len(run.t), 0)), np.empty(0)
    return AgentTracks(
        id=np.empty(0, dtype=np.int64),
        **dict.fromkeys(("x", "y", "vx", "vy"), nowhere),
        radius=none,
        mass=none,
        jump=None,
    )


def encounter(run: Trajectories, jump_speed: float) -> Encounter:
    """Return the relative positions of all people; ``jump_speed`` (m/s) detects teleports."""
    return run.cached(("encounter", jump_speed), lambda: _encounter(run, jump_speed))


def robot_velocities(run: Trajectories, jump_speed: float) -> tuple[Array, Array]:
    """Return the robot's world velocity (N,), (N,), m/s."""
    return run.cached(
        ("robot_velocities", jump_speed), lambda: robot_velocity(run.t, robot_of(run), jump_speed)
    )


def people_velocities(run: Trajectories, jump_speed: float) -> tuple[Array, Array]:
    """Return people's world velocities (N, M), (N, M), m/s; NaN if absent or unknown."""
    return run.cached(
        ("people_velocities", jump_speed), lambda: agent_velocities(run.t, people(run), jump_speed)
    )


def people_speeds(run: Trajectories, jump_speed: float) -> Array:
    """Return people's speeds (N, M), m/s; NaN if absent or unknown."""
    return run.cached(
        ("people_speeds", jump_speed), lambda: np.hypot(*people_velocities(run, jump_speed))
    )


def relative_velocity(run: Trajectories, jump_speed: float) -> tuple[Array, Array]:
    """Return each person's velocity minus the robot's (N, M), (N, M), m/s; NaN if unknown."""
    rx, ry = robot_velocities(run, jump_speed)
    ax, ay = people_velocities(run, jump_speed)
    return ax - rx[:, None], ay - ry[:, None]


def approach(
    run: Trajectories, jump_speed: float, contact_tol: float, rel_speed_tol: float
) -> tuple[Array, Array]:
    """Return time to contact (s) and relative speed (m/s) of each person (N, M), (N, M)."""

    def compute() -> tuple[Array, Array]:
        velocity = relative_velocity(run, jump_speed)
        pair = encounter(run, jump_speed)
        tau = time_to_contact(pair, velocity, contact_tol=contact_tol, rel_speed_tol=rel_speed_tol)
        return tau, np.hypot(*velocity)

    return run.cached(("approach", jump_speed, contact_tol, rel_speed_tol), compute)


def onsets(
    run: Trajectories, jump_speed: float, contact_tol: float, release_gap: float
) -> Contacts:
    """Return `contact_onsets` of a run."""
    return run.cached(
        ("onsets", jump_speed, contact_tol, release_gap),
        lambda: contact_onsets(
            encounter(run, jump_speed), contact_tol=contact_tol, release_gap=release_gap
        ),
    )


def _encounter(run: Trajectories, jump_speed: float) -> Encounter:
    robots = valid_robot_steps(run.t, robot_of(run), jump_speed)[:, None]
    valid = valid_agent_steps(run.t, people(run), jump_speed) & robots
    # Only the valid steps depend on the speed.
    found: Encounter = run.cached("encounter", lambda: _measured(run, valid))
    return replace(found, valid=valid)


def _measured(run: Trajectories, valid: Mask) -> Encounter:
    robot, agents = robot_of(run), people(run)
    px = inf_to_nan(agents.x) - inf_to_nan(robot.x)[:, None]
    py = inf_to_nan(agents.y) - inf_to_nan(robot.y)[:, None]
    distance, footprint, theta = np.hypot(px, py), footprint_of(run), inf_to_nan(robot.theta)
    if footprint is None:
        reach = agents.radius + robot.radius
        gap = distance - reach
    else:
        reach = agents.radius
        gap = footprint.gap(*into_frame(theta, px, py)) - reach
    return Encounter(
        t=run.t,
        px=px,
        py=py,
        reach=reach,
        distance=distance,
        gap=gap,
        valid=valid,
        footprint=footprint,
        theta=theta,
    )


def time_to_contact(
    pair: Encounter, velocity: tuple[Array, Array], *, contact_tol: float, rel_speed_tol: float
) -> Array:
    """Return the time until two discs with constant velocities touch (N, M), s.

    0 in contact, inf if they never touch or a velocity is unknown. The smaller root of ``|p + tau
    v| = reach``, in the form without cancellation.

    Args:
        pair: relative positions.
        velocity: relative velocities, m/s.
        contact_tol: a miss by less than this is a hit, m.
        rel_speed_tol: slower relative motion counts as none, m/s.
    """
    px, py = pair.px, pair.py
    vx, vy = velocity
    if pair.footprint is not None:
        moves = np.hypot(vx, vy) > rel_speed_tol
        at, along = into_frame(pair.theta, px, py), into_frame(pair.theta, vx, vy)
        tau = pair.footprint.first_touch(*at, *along, pair.reach + contact_tol)
        tau = np.where(moves, tau, np.inf)
    else:
        tau = np.full(px.shape, np.inf)
        _discs_meet(
            (px, py), (vx, vy), pair.gap, pair.distance, pair.reach, contact_tol, rel_speed_tol, tau
        )
    return np.where(touching(pair, contact_tol), 0.0, tau)


@kernel
def _discs_meet(
    at: tuple[Array, Array], velocity: tuple[Array, Array], gap: Array, distance: Array,
    reach: Array, contact_tol: float, rel_speed_tol: float, tau: Array,
) -> None:  # fmt: skip
    """Write the time until two discs touch (N, M), s, where they do."""
    (px, py), (vx, vy) = at, velocity
    for k in range(px.shape[0]):
        for m in range(px.shape[1]):
            wx, wy = vx[k, m], vy[k, m]
            nearing = -(px[k, m] * wx + py[k, m] * wy)
            if not nearing > 0.0:  # nor for NaN
                continue
            miss, most = abs(px[k, m] * wy - py[k, m] * wx), reach[m] + contact_tol
            # Most miss clearly, which needs no root.
            if miss * miss > most * most * (wx * wx + wy * wy) * (1.0 + _CLEARLY) + _CLEARLY:
                continue
            speed = math.hypot(wx, wy)
            if speed > rel_speed_tol and miss <= most * speed:
                root = math.sqrt(max((reach[m] * speed) ** 2 - miss**2, 0.0))
                tau[k, m] = gap[k, m] * (distance[k, m] + reach[m]) / (nearing + root)


def touching(pair: Encounter, contact_tol: float) -> Mask:
    """Return a mask of samples (N, M) in which the surfaces touch or overlap."""
    return pair.gap <= contact_tol


def contact_runs(pair: Encounter, contact_tol: float) -> int:
    """Count runs of touching samples over all people; a teleport or absence ends a run."""
    touch = touching(pair, contact_tol)
    return int(touch[:1].sum() + (touch[1:] & ~(touch[:-1] & pair.valid)).sum())


def contact_onsets(pair: Encounter, *, contact_tol: float, release_gap: float) -> Contacts:
    """Return contacts of the continuous piecewise linear motion, with hysteresis, by time.

    A contact begins when the gap reaches 0 on a valid step, or when a body appears overlapping;
    it ends when the gap at a sample exceeds ``release_gap`` (m), or when a body disappears or is
    teleported.
    """
    return contact_events(
        pair.t,
        pair.gap,
        _first_touch(pair, contact_tol),
        pair.valid,
        contact_tol=contact_tol,
        release_gap=release_gap,
    )


def contact_events(
    t: Array,
    gap: Array,
    fraction: Array,
    valid: Mask,
    *,
    contact_tol: float,
    release_gap: float,
) -> Contacts:
    """Return `contact_onsets` for any M bodies and the robot.

    Args:
        t: (N,) times, s.
        gap: (N, M) between the surfaces, m; NaN where absent.
        fraction: (N-1, M) of each step at which the surfaces first touch, NaN if they do not.
        valid: (N-1, M) steps on which both bodies moved continuously.
        contact_tol: surfaces closer than this touch, m.
        release_gap: gap beyond which a contact ends, m.
    """
    touch = gap <= contact_tol
    swept = valid & np.isfinite(fraction)
    appears = np.ones(touch.shape, dtype=bool)
    appears[1:] = ~valid
    apart = ~(gap <= release_gap + contact_tol)  # absent people too
    free = ~_in_contact(touch, swept, appears, apart)
    k_first, a_first = np.nonzero(appears & touch)
    k_swept, a_swept = np.nonzero(swept & free[:-1])
    start, step = t[k_swept], np.diff(t)[k_swept]
    time = np.concatenate([t[k_first], start + fraction[k_swept, a_swept] * step])
    agent, sample = np.concatenate([a_first, a_swept]), np.concatenate([k_first, k_swept])
    order = np.lexsort((agent, time))
    return Contacts(time=time[order], agent=agent[order], sample=sample[order])


def _in_contact(touch: Mask, swept: Mask, appears: Mask, apart: Mask) -> Mask:
    """Return a mask of pairs in contact after each sample (N, M).

    Every sample either sets the state or keeps that of the previous sample.
    """
    begins = appears & touch
    begins[1:] |= swept & ~apart[1:]
    decides = begins | apart | appears
    rows = np.arange(len(touch))[:, None]
    last = np.maximum.accumulate(np.where(decides, rows, 0), axis=0)
    return np.take_along_axis(begins, last, axis=0)


def _first_touch(pair: Encounter, contact_tol: float) -> Array:
    """Return the fraction of each step (N-1, M) at which surfaces first touch; NaN if they do not.

    A footprint moves along the step with its mean heading, and turns at both ends.
    """
    if pair.footprint is None:
        return _discs_touch(pair, contact_tol)
    theta = pair.theta[:-1] + wrap(np.diff(pair.theta)) / 2.0
    x, y = into_frame(theta, pair.px[:-1], pair.py[:-1])
    dx, dy = into_frame(theta, np.diff(pair.px, axis=0), np.diff(pair.py, axis=0))
    reach = pair.reach + contact_tol
    first = pair.footprint.first_touch(x, y, dx, dy, reach)
    touch = touching(pair, contact_tol)
    at_start = touch[:-1] | (pair.footprint.gap(x, y) <= reach)
    first = np.where(at_start, 0.0, np.where(touch[1:], np.minimum(first, 1.0), first))
    return np.where(first <= 1.0, first, np.nan)


def _discs_touch(pair: Encounter, contact_tol: float) -> Array:
    """Compute `_first_touch` for discs, whose distance is convex along a step."""
    px, py = pair.px[:-1], pair.py[:-1]
    dx, dy = np.diff(pair.px, axis=0), np.diff(pair.py, axis=0)
    square, nearing = dx**2 + dy**2, -(px * dx + py * dy)
    moves = square > 0
    nearest = np.clip(np.divide(nearing, square, out=np.zeros(px.shape), where=moves), 0.0, 1.0)
    closest = np.hypot(px + nearest * dx, py + nearest * dy)
    root = np.sqrt(np.maximum(square * pair.reach**2 - (px * dy - py * dx) ** 2, 0.0))
    gap = pair.gap[:-1] * (pair.distance[:-1] + pair.reach)
    onset = np.divide(gap, nearing + root, out=np.zeros(px.shape), where=nearing + root > 0)
    # with the tolerance, the root of a touch may lie outside the step
    return np.where(closest <= pair.reach + contact_tol, np.clip(onset, 0.0, nearest), np.nan)
