"""Records of TtcaDca: its parameters, and the neighbours that ``prepare`` leaves in ``work``."""

from __future__ import annotations

from crowdbot.plugin import (
    WORK_COLUMNS,
    CostParams,
    record_type,
)


class Params(CostParams):
    """Parameters of TtcaDca, as a record.

    Attributes:
        inv_ttca2, inv_dca2: one over the squared spreads in time (1/s^2) and distance (1/m^2).
        sigma_angle, sigma_speed: spreads in heading (rad) and speed (m/s).
        walls: 1 if walls count.
    """

    inv_ttca2: float
    inv_dca2: float
    sigma_angle: float
    sigma_speed: float
    walls: float


class Header:
    """Row 0 of ``work``: number of neighbours that follow, and the sum of all weights."""

    count: float
    total: float


class Neighbour:
    """A neighbour in ``work``: d, q and velocity, see `ttca_dca_build`, and its weight k."""

    dx: float
    dy: float
    qx: float
    qy: float
    vx: float
    vy: float
    weight: float


PARAMS, HEADER = record_type(Params), record_type(Header)
NEIGHBOUR = record_type(Neighbour, WORK_COLUMNS)
NEGLIGIBLE = 90.0  # exp(-45) of a cost of order one is below double precision
CLOSEST = 1e-6  # gaps and distances below this count as this, m
