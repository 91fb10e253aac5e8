"""What the two halves of TtcaDca share."""

from __future__ import annotations

# Entries of params, after the range.
INV_TTCA2, INV_DCA2, SIGMA_ANGLE, SIGMA_SPEED, WALLS = range(2, 7)
# Columns of work: entry of row 0; of the others.
TOTAL = 1
WEIGHT = 6
NEGLIGIBLE = 90.0  # exp(-45) of a cost of order one is below double precision
CLOSEST = 1e-6  # gaps and distances below this count as this, m
