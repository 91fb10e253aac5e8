"""Parameters of path finding."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class WayFinding(NamedTuple):
    """People's choice among paths around walls; see `crowdbot.dsl.scenario.routing`.

    Attributes:
        spread: largest distance from a corner when passing, m.
        patience: time without progress before looking for another path, s.
        detour: largest relative length of the other path.
        key: key of the random distances from corners; for compiled code as `numpy.uint64`.
    """

    spread: float = 0.5
    patience: float = 5.0
    detour: float = 1.5
    key: int | np.uint64 = 0
