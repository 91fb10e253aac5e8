"""The three policies that the original's scenes share, from its presets.xml.

All use gradient descent. Each entry lists a cost's kind, weight, range and parameters.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from crowdbot.core.exchange.scene import Data
from crowdbot.core.exchange.umans.policies import DEFAULTS

_Cost = tuple[str, float, float, Mapping[str, float]]


def _vision(ttca: float, dca: float) -> Mapping[str, float]:
    return {"sigma_ttca": ttca, "sigma_dca": dca, "sigma_angle_goal": 2.0, "sigma_speed_goal": 1.0}


#: Policy -> relaxation time (s) and its costs.
_PRESETS: Mapping[int, tuple[float, tuple[_Cost, ...]]] = {
    0: (0.1, (("social_forces_avoidance", 5.0, 1.0, {}), ("ttca_dca", 20.0, 5.0, _vision(0.1, 0.1)),
              ("goal_reaching_force", 1.0, 15.0, {}))),
    1: (0.3, (("social_forces_avoidance", 0.1, 0.5, {}),
              ("ttca_dca", 20.0, 5.0, _vision(1.0, 0.3)))),
    2: (0.5, (("social_forces_avoidance", 1.0, 15.0, {}), ("goal_reaching_force", 1.0, 15.0, {}))),
}  # fmt: skip
PRESETS = tuple(_PRESETS)


def preset(number: int) -> Data:
    """Return ``{policy, costs}`` of a preset."""
    relaxation, costs = _PRESETS[number]
    stiffness: Any = DEFAULTS["contact_stiffness"]
    return {
        "policy": {"kind": "velocity_space", "method": "gradient", "relaxation_time": relaxation,
                   "contact_stiffness": stiffness},
        "costs": {
            kind: {"kind": kind, "weight": weight, "range": {"value": reach, "measure": "centre"},
                   **more}
            for kind, weight, reach, more in costs
        },
    }  # fmt: skip
