"""The robot and each person as two discs that move: time to contact, and contact events.

N samples, M people; world frame, SI units. NaN stands for "not there" or "not known".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.preprocess import (
    Mask,
    agent_velocities,
    robot_velocity,
    valid_agent_steps,
    valid_robot_steps,
)
from crowdbot.core.trajectory import AgentTracks, Array, RobotTrack, Trajectories


@dataclass(frozen=True, slots=True, kw_only=True)
class Encounter:
    """Every person relative to the robot.

    Attributes:
        t: (N,) sample times, s.
        px, py: (N, M) position of each person minus the robot's, m.
        reach: (M,) sum of both radii, m.
        valid: (N-1, M) steps on which both bodies moved continuously.
    """

    t: Array
    px: Array
    py: Array
    reach: Array
    valid: Mask

    @property
    def distance(self) -> Array:
        """Distance between centres (N, M), m."""
        return np.hypot(self.px, self.py)


@dataclass(frozen=True, slots=True, kw_only=True)
class Contacts:
    """Beginnings of contact: time (s), column of the person, sample before the onset; (K,)."""

    time: Array
    agent: NDArray[np.int64]
    sample: NDArray[np.int64]


def disc_problem(run: Trajectories) -> str:
    """Why the robot of a run is no disc, as a reason of a score; empty when it is one."""
    if run.robot is None:
        return "invalid_no_robot"
    return "" if run.robot_footprint is None else "invalid_footprint"


def people(run: Trajectories) -> AgentTracks:
    """Everybody in a run; nobody at all (M = 0) in a run without people."""
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


def encounter(t: Array, robot: RobotTrack, agents: AgentTracks, jump_speed: float) -> Encounter:
    """Relative positions of all people; ``jump_speed`` (m/s) tells teleports."""
    valid = valid_agent_steps(t, agents, jump_speed)
    return Encounter(
        t=t,
        px=_finite(agents.x) - _finite(robot.x)[:, None],
        py=_finite(agents.y) - _finite(robot.y)[:, None],
        reach=agents.radius + robot.radius,
        valid=valid & valid_robot_steps(t, robot, jump_speed)[:, None],
    )


def relative_velocity(
    t: Array, robot: RobotTrack, agents: AgentTracks, jump_speed: float
) -> tuple[Array, Array]:
    """Velocity of each person minus the robot's (N, M), (N, M), m/s; NaN where unknown."""
    rx, ry = robot_velocity(t, robot, jump_speed)
    ax, ay = agent_velocities(t, agents, jump_speed)
    return ax - rx[:, None], ay - ry[:, None]


def time_to_contact(
    pair: Encounter, velocity: tuple[Array, Array], *, contact_tol: float, rel_speed_tol: float
) -> Array:
    """Time until two discs that keep their velocities touch (N, M), s.

    0 where they touch already, inf where they never will, or where a velocity is unknown. The
    smaller root of ``|p + tau v| = reach``, in the form without cancellation.

    Args:
        pair: relative positions.
        velocity: relative velocities, m/s.
        contact_tol: a miss by less than this is a hit, m.
        rel_speed_tol: slower relative motion counts as none, m/s.
    """
    px, py = pair.px, pair.py
    vx, vy = velocity
    distance, speed = pair.distance, np.hypot(vx, vy)
    approach = -(px * vx + py * vy)
    miss = np.abs(px * vy - py * vx)
    hits = (speed > rel_speed_tol) & (approach > 0) & (miss <= (pair.reach + contact_tol) * speed)
    root = np.sqrt(np.maximum((pair.reach * speed) ** 2 - miss**2, 0.0))
    gap = (distance - pair.reach) * (distance + pair.reach)
    tau = np.divide(gap, approach + root, out=np.full(px.shape, np.inf), where=hits)
    return np.where(distance <= pair.reach + contact_tol, 0.0, tau)


def touching(pair: Encounter, contact_tol: float) -> Mask:
    """Samples (N, M) at which the surfaces touch or overlap."""
    return pair.distance <= pair.reach + contact_tol


def contact_runs(pair: Encounter, contact_tol: float) -> int:
    """Maximal runs of touching samples, over all people; a teleport or absence ends a run."""
    touch = touching(pair, contact_tol)
    return int(touch[:1].sum() + (touch[1:] & ~(touch[:-1] & pair.valid)).sum())


def contact_onsets(pair: Encounter, *, contact_tol: float, release_gap: float) -> Contacts:
    """Contacts of the continuous piecewise linear motion, with hysteresis, by time.

    A contact begins when the gap reaches 0 on a valid step, or when a body appears overlapping;
    it ends when the gap at a sample exceeds ``release_gap`` (m), or when a body disappears or is
    teleported.
    """
    touch = touching(pair, contact_tol)
    fraction = _first_touch(pair, contact_tol)
    swept = pair.valid & np.isfinite(fraction)
    appears = np.ones(touch.shape, dtype=bool)
    appears[1:] = ~pair.valid
    free = ~_held(pair, touch, swept, appears, release_gap + contact_tol)
    k_first, a_first = np.nonzero(appears & touch)
    k_swept, a_swept = np.nonzero(swept & free[:-1])
    start, step = pair.t[k_swept], np.diff(pair.t)[k_swept]
    time = np.concatenate([pair.t[k_first], start + fraction[k_swept, a_swept] * step])
    agent, sample = np.concatenate([a_first, a_swept]), np.concatenate([k_first, k_swept])
    order = np.lexsort((agent, time))
    return Contacts(time=time[order], agent=agent[order], sample=sample[order])


def _held(pair: Encounter, touch: Mask, swept: Mask, appears: Mask, release: float) -> Mask:
    """Whether each pair is in contact after each sample (N, M).

    Every sample either decides this anew or leaves it as it was after the last one that did.
    """
    apart = ~(pair.distance - pair.reach <= release)  # absent people, too
    begins = appears & touch
    begins[1:] |= swept & ~apart[1:]
    decides = begins | apart | appears
    rows = np.arange(len(pair.t))[:, None]
    last = np.maximum.accumulate(np.where(decides, rows, 0), axis=0)
    return np.take_along_axis(begins, last, axis=0)


def _first_touch(pair: Encounter, contact_tol: float) -> Array:
    """Fraction of each step (N-1, M) at which the surfaces first touch; NaN where they do not.

    The distance along a step is convex, so its smallest value decides.
    """
    px, py = pair.px[:-1], pair.py[:-1]
    dx, dy = np.diff(pair.px, axis=0), np.diff(pair.py, axis=0)
    square, approach = dx**2 + dy**2, -(px * dx + py * dy)
    moves = square > 0
    nearest = np.clip(np.divide(approach, square, out=np.zeros(px.shape), where=moves), 0.0, 1.0)
    closest = np.hypot(px + nearest * dx, py + nearest * dy)
    root = np.sqrt(np.maximum(square * pair.reach**2 - (px * dy - py * dx) ** 2, 0.0))
    start = np.hypot(px, py)
    gap = (start - pair.reach) * (start + pair.reach)
    onset = np.divide(gap, approach + root, out=np.zeros(px.shape), where=approach + root > 0)
    # the root of a touch within the tolerance may lie beside the step
    return np.where(closest <= pair.reach + contact_tol, np.clip(onset, 0.0, nearest), np.nan)


def _finite(values: Array) -> Array:
    return np.where(np.isfinite(values), values, np.nan)
