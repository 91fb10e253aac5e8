"""Candidate velocities: fans of directions and speeds, regular or random.

A candidate is ``base + R * turned(c)``, where c is a candidate of the unit fan (its length is the
fraction of the radius R, its angle counts from the base direction).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from crowdbot.core.crowd.velocity_search.minstd import between, following
from crowdbot.core.crowd.velocity_search.records import AgentRecord
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array

# Codes of the options of `Sampling`.
ZERO, CURRENT = range(2)  # base
UNIT, ALONG_CURRENT, ALONG_PREFERRED = range(3)  # base direction
PREFERRED_SPEED, MAXIMUM_SPEED, MAXIMUM_ACCELERATION = range(3)  # radius


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """Candidate velocities of one search: a regular fan or random points.

    Attributes:
        speeds, angles: numbers of the regular fan.
        opening: angle of the fan, rad.
        include_base: True if the first of the speeds is the base itself.
        base: ``ZERO`` or ``CURRENT`` velocity.
        direction: ``UNIT`` (along x), ``ALONG_CURRENT`` or ``ALONG_PREFERRED`` velocity.
        radius: ``PREFERRED_SPEED``, ``MAXIMUM_SPEED`` or ``MAXIMUM_ACCELERATION``: the change of
            velocity in one decision, at most twice the largest speed.
        random: number of random candidates instead of the regular fan; 0 for the fan.
    """

    speeds: int = 4
    angles: int = 19
    opening: float = math.pi
    include_base: bool = True
    base: int = ZERO
    direction: int = ALONG_PREFERRED
    radius: int = PREFERRED_SPEED
    random: int = 0

    def fan(self) -> Array:
        """Return the regular candidates (S, 2) of the unit fan."""
        return fan(self.speeds, self.angles, self.opening, include_base=self.include_base)


class FanOptions(NamedTuple):
    """Options of `Sampling` that define an agent's fan, for compiled code.

    Attributes:
        base, direction, radius: their codes.
        half: half the opening, rad.
        drawn: True if candidates are random.
    """

    base: int
    direction: int
    radius: int
    half: float
    drawn: bool


#: The search for ``global`` if there is no closed form.
EVERYWHERE = Sampling(
    speeds=11, angles=36, opening=2.0 * math.pi, direction=UNIT, radius=MAXIMUM_SPEED
)


def fan(speeds: int, angles: int, opening: float, *, include_base: bool = True) -> Array:
    """Return candidates (S, 2) of radius 1 around the direction (1, 0): rings, slow to fast.

    Within a ring from -opening/2 to +opening/2, counter-clockwise. With the base included, it
    replaces the first ring.
    """
    turns = 2.0 * math.pi
    closed = math.isclose(opening, turns, rel_tol=1e-9)
    step = opening / (angles if closed else max(1, angles - 1))
    theta = -0.5 * opening + step * np.arange(angles)
    directions = np.column_stack([np.cos(theta), np.sin(theta)])
    if include_base:
        lengths = np.arange(1, speeds) / max(1, speeds - 1)
        return np.concatenate([np.zeros((1, 2)), *(directions * part for part in lengths)])
    return np.concatenate([directions * part for part in np.arange(1, speeds + 1) / speeds])


@kernel
def radius_of(agent: AgentRecord, kind: int) -> float:
    """Return the radius R of an agent's fan, m/s."""
    if kind == PREFERRED_SPEED:
        return float(agent.preferred)
    if kind == MAXIMUM_SPEED:
        return float(agent.max_speed)
    return float(min(2.0 * agent.max_speed, agent.max_acceleration * agent.time_step))


@kernel
def direction_of(agent: AgentRecord, kind: int) -> tuple[float, float]:
    """Return the base direction of an agent's fan, of length 1.

    An agent at rest has no direction: the preferred one is taken instead. The original takes the
    zero vector, so that all candidates are the base.
    """
    if kind == UNIT:
        return 1.0, 0.0
    x, y = agent.pvx, agent.pvy
    if kind == ALONG_CURRENT:
        still = agent.vx == 0.0 and agent.vy == 0.0
        if not still or agent.parity != 0.0:
            x, y = agent.vx, agent.vy
    length = math.sqrt(x * x + y * y)
    return (x / length, y / length) if length > 0.0 else (0.0, 0.0)


@kernel
def frame_of(agent: AgentRecord, options: FanOptions, frame: Array) -> float:
    """Write the frame of an agent's candidates, and note it in ``agent``; return the radius.

    Args:
        frame: (4,) output: base, and base direction times radius, m/s.
    """
    scale = radius_of(agent, options.radius)
    ex, ey = direction_of(agent, options.direction)
    frame[0], frame[1] = (agent.vx, agent.vy) if options.base == CURRENT else (0.0, 0.0)
    frame[2], frame[3] = scale * ex, scale * ey
    fastest = scale if options.base == ZERO else scale + math.hypot(frame[0], frame[1])
    agent.fastest = (1.0 + 1e-9) * fastest
    agent.asked_x, agent.asked_y = frame[0], frame[1]
    # With parity, candidates are rounded to single precision.
    agent.asked_radius = scale + (1e-9 if agent.parity == 0.0 else 1e-6) * fastest
    return scale


@kernel
def draw_candidates(agent: AgentRecord, half: float, radius: float, drawn: Array) -> None:
    """Fill ``drawn`` (S, 2) with random candidates of the unit fan; advances the generator.

    Angle, then length: uniform in length, not in area, as in the original.
    """
    state, fraction = int(agent.random), 1.0 / radius
    for s in range(drawn.shape[0]):
        state = following(state)
        drawn[s, 0] = between(state, -half, half)
        state = following(state)
        drawn[s, 1] = between(state, 0.0, radius) * fraction
    agent.random = float(state)
    for s in range(drawn.shape[0]):  # separate from the draws, so that it vectorises
        cosine, sine = turn(drawn[s, 0])
        length = drawn[s, 1]
        drawn[s, 0], drawn[s, 1] = length * cosine, length * sine


# Taylor coefficients of sin(q) / q - 1 and 1 - cos(q) in powers of q^2.
_S1, _S2, _S3, _S4, _S5, _S6, _S7 = ((-1) ** k / math.factorial(2 * k + 1) for k in range(1, 8))
_C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8 = (
    (-1) ** (k + 1) / math.factorial(2 * k) for k in range(1, 9)
)


@inline_kernel
def turn(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle in [-pi, pi], by Taylor series of a quarter of it."""
    q = 0.25 * angle
    z = q * q
    s = q + q * z * (_S1 + z * (_S2 + z * (_S3 + z * (_S4 + z * (_S5 + z * (_S6 + z * _S7))))))
    e = z * (_C1 + z * (_C2 + z * (_C3 + z * (_C4 + z * (_C5 + z * (_C6 + z * (_C7 + z * _C8)))))))
    c = 1.0 - e
    s, c = 2.0 * s * c, 1.0 - 2.0 * s * s  # doubled, twice
    return 1.0 - 2.0 * s * s, 2.0 * s * c
