"""Check that the robot braked once a contact was foreseeable.

Based on responsibility in RSS (Shalev-Shwartz, Shammah, Shashua 2017, arXiv:1708.06374): not every
contact can be prevented, but a robot that gives the proper response in time is not to blame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.trajectories.encounters import (
    encounter,
    people_velocities,
    relative_velocity,
    robot_velocities,
    time_to_contact,
)
from crowdbot.core.trajectories.fault.touch_point import touch_point
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Mask

#: Slower relative motion is ignored, m/s.
_STILL = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultRule:
    """Parameters of the rule if a contact is the robot's fault.

    Attributes:
        speed: approach speed below which the robot is not at fault, m/s.
        reaction: reaction time before it must brake, s.
        braking: required deceleration, m/s².
        margin: predicted distance that counts as a contact, m.
    """

    speed: float
    reaction: float
    braking: float
    margin: float


def braked_in_time(
    run: Trajectories,
    rule: FaultRule,
    onset: Array,
    sample: NDArray[np.int64],
    agent: NDArray[np.int64],
    jump_speed: float,
) -> Mask:
    """Return a mask of contacts (K,) before which the robot had braked in time.

    A contact is foreseeable from the first sample on at which both, keeping their velocities, would
    come within the margin before the robot could react and come to rest. The robot may continue for
    the reaction time, then it must slow down; at the contact it may be ``rule.speed`` faster than
    that. A contact foreseeable only within the reaction time is not its fault.

    Args:
        run: a run with a robot.
        onset: (K,) times of the contacts, s.
        sample: (K,) the last sample before each contact.
        agent: (K,) column of the person; -1: unknown, counts as not braked.
        jump_speed: speed that detects teleports if none were recorded, m/s.
    """
    found = np.zeros(len(sample), dtype=bool)
    if not (agent >= 0).any():
        return found
    speed = np.hypot(*robot_velocities(run, jump_speed))
    gap, after = encounter(run, jump_speed).gap, np.minimum(sample + 1, len(run.t) - 1)
    shown = np.fmin(gap[sample, agent], gap[after, agent]) <= rule.margin
    ahead = run.cached(
        ("foreseen", rule.margin, jump_speed), lambda: _foreseen(run, rule.margin, jump_speed)
    )
    turns = encounter(run, jump_speed).footprint is not None
    for k in np.flatnonzero((agent >= 0) & shown):
        own, soon = speed, ahead[:, agent[k]]
        if turns:
            own, soon = _turning(run, own, soon, int(agent[k]), int(sample[k]), jump_speed)
        found[k] = _braked(run.t, own, soon, onset[k], int(sample[k]), rule)
    return found


def _turning(
    run: Trajectories, speed: Array, ahead: Array, agent: int, last: int, jump_speed: float
) -> tuple[Array, Array]:
    """Return speed (N,) and time to contact (N,) of the point that is nearest to a person.

    A long robot that turns comes nearer although its centre may stand. Samples after ``last`` are
    those of the centre.
    """
    sample = np.arange(last + 1)
    there = touch_point(run, sample, np.full(last + 1, agent), jump_speed)
    px, py = (v[: last + 1, agent] for v in people_velocities(run, jump_speed))
    nears = there.closing - (px * there.nx + py * there.ny)
    gap = np.maximum(encounter(run, jump_speed).gap[: last + 1, agent], 0.0)
    soon = np.divide(gap, nears, out=np.full(last + 1, np.inf), where=nears > _STILL)
    speed, ahead = speed.copy(), ahead.copy()
    speed[: last + 1] = np.fmax(speed[: last + 1], there.speed)
    ahead[: last + 1] = np.fmin(ahead[: last + 1], soon)
    return speed, ahead


def _foreseen(run: Trajectories, margin: float, jump_speed: float) -> Array:
    """Return the time (N, M) until a pair with constant velocities comes within the margin, s."""
    velocity = relative_velocity(run, jump_speed)
    pair = encounter(run, jump_speed)
    return time_to_contact(pair, velocity, contact_tol=margin, rel_speed_tol=_STILL)


def _braked(t: Array, speed: Array, ahead: Array, onset: float, last: int, rule: FaultRule) -> bool:
    """Like `braked_in_time`, for the contact after sample ``last`` with one person."""
    time = t[: last + 1] - onset
    fastest = float(np.max(speed[: last + 1][time >= -rule.reaction], initial=speed[last]))
    needs = rule.reaction + fastest / rule.braking
    begins = max(0, int(np.searchsorted(time, -needs)) - 1)
    soon = max(needs, -time[begins]) + 1e-9
    seen = begins + np.flatnonzero(ahead[begins : last + 1] <= soon)
    if not len(seen):
        return True
    first = float(time[seen[0]])
    goes_on = (time >= first - 1e-9) & (time <= first + rule.reaction + 1e-9)
    allowed = float(speed[: last + 1][goes_on].max())
    allowed -= rule.braking * max(0.0, -first - rule.reaction)
    return bool(speed[last] <= max(0.0, allowed) + rule.speed + 1e-9)
