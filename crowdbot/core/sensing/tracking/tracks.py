"""Tracks of people: a Kalman filter with constant velocity for each; compiled.

The state's two axes are independent and have equal noise, so one 2 x 2 covariance of place and
velocity serves both.
"""

from __future__ import annotations

from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.types.arrays import Array

#: Columns of a track: number; place (m), velocity (m/s); variances of place and velocity, and
#: their covariance; first and last time seen (s); scans in which it was seen, and the
#: share of the last ones in which both legs were;
#: place where it was first seen (m); 1 once it counts as a person.
ID, X, Y, VX, VY, PP, VV, PV, BORN, SEEN, HITS, BOTH, X0, Y0, PERSON = range(15)
COLUMNS = 15
#: Acceleration of people as white noise, m/s^2, and the velocity that a new track may have, m/s.
_ACCELERATION, _FIRST_SPEED = 1.1, 1.0
#: Noise of a place from both legs, from legs that touch each other, from one leg, and from what is
#: seen of a person who is partly hidden, m.
PAIR_NOISE, WIDE_NOISE, LEG_NOISE, PARTLY_NOISE = 0.03, 0.05, 0.16, 0.3


@kernel
def begin(track: Array, number: float, x: float, y: float, noise: float, t: float) -> None:
    """Start a track at a measured position (m) with some noise (m) at a time (s)."""
    track[:] = 0.0
    track[ID], track[X], track[Y], track[X0], track[Y0] = number, x, y, x, y
    track[PP], track[VV] = noise * noise, _FIRST_SPEED * _FIRST_SPEED
    track[BORN], track[SEEN] = t, t


@kernel
def predict(track: Array, dt: float) -> None:
    """Predict a track by some seconds."""
    track[X] += dt * track[VX]
    track[Y] += dt * track[VY]
    q = _ACCELERATION * _ACCELERATION * dt
    track[PP] += dt * (2.0 * track[PV] + dt * track[VV]) + q * dt * dt / 3.0
    track[PV] += dt * track[VV] + q * dt / 2.0
    track[VV] += q


@kernel
def correct(track: Array, x: float, y: float, noise: float) -> None:
    """Correct a track with a measured position (m) with some noise (m)."""
    total = track[PP] + noise * noise
    place, velocity = track[PP] / total, track[PV] / total
    dx, dy = x - track[X], y - track[Y]
    track[X] += place * dx
    track[Y] += place * dy
    track[VX] += velocity * dx
    track[VY] += velocity * dy
    track[VV] -= velocity * track[PV]
    track[PV] *= 1.0 - place
    track[PP] *= 1.0 - place
