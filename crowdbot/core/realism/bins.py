"""Densities and bins of the comparison; docs/reference/realism.md explains the choice."""

from __future__ import annotations

import numpy as np

from crowdbot.core.types.arrays import Array

#: Samples per second of tracks, Hz, and the time between them, s.
RATE, DT = 4.0, 0.25
#: Length of the window in which density is measured, m.
WINDOW = 4.0
#: Borders of the density cells, 1/m^2, and the cells' names.
DENSITY_EDGES = np.array([0.3, 0.65, 1.15, 1.7, 2.4])
CELLS = ("0.45", "0.9", "1.4", "2.0")
#: Both flows: everyone in one direction, and half of the people in each direction.
FLOWS = ("uni", "counter")
#: The five features, in the order of the columns of `features`.
FEATURES = ("speed", "acceleration", "turning", "nearest", "time_to_collision")
#: Others are visible within this distance, m; the cameras did not see farther ones.
REACH = 3.9
#: Diameter of the discs used for times to collision, m.
DISC = 0.4
#: Times to collision beyond the last bin, s.
NEVER = 9.0
#: Minimum number of reference samples for a cell to count.
LEAST_SAMPLES = 150
_BEYOND = 9e9

EDGES: dict[str, Array] = {
    "speed": np.linspace(0.0, 2.6, 27),
    "acceleration": np.append(np.linspace(0.0, 2.0, 41), _BEYOND),
    "turning": np.linspace(-2.5, 2.5, 51),
    "nearest": np.append(np.linspace(0.0, 2.4, 25), _BEYOND),
    "time_to_collision": np.append(np.linspace(0.0, 5.0, 21), 10.0),
}
#: Units of the features.
UNITS = {
    "speed": "m/s",
    "acceleration": "m/s²",
    "turning": "rad/s",
    "nearest": "m",
    "time_to_collision": "s",
}
#: Borders of the bins of the fundamental diagram, 1/m^2.
DIAGRAM_EDGES = np.array([0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5, 1.7, 1.9, 2.1, 2.4])
#: Borders of the bins of the pair correlation, m.
PAIR_EDGES = np.linspace(0.0, 2.4, 25)


def cell_of(density: float) -> int:
    """Return the index of the density cell, -1 outside all."""
    found = int(np.searchsorted(DENSITY_EDGES, density, side="right")) - 1
    return found if 0 <= found < len(CELLS) else -1
