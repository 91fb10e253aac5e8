"""Parameters of dwa as a vector for compiled code, and the names of its entries."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array, RobotLimits
from crowdbot.plugins.planners.dwa.dwa import DwaSpec

#: Indices into the vector.
A_MAX, ALPHA_MAX, HORIZON, TURN_TIME, RADIUS, MARGIN, COMFORT, GROWTH, PERIOD = range(9)
PROGRESS, HEADING, CLEARANCE, IMPACT, SMOOTHNESS, V_MAX, W_MAX, REACH = range(9, 17)
PARAMETERS = 17


def parameters_of(spec: DwaSpec, limits: RobotLimits, radius: float, reach: float) -> Array:
    """Return the vector of parameters; its period is that of the last step.

    Args:
        spec: of the planner.
        radius: rounding of its outline, m.
        reach: radius of the disc that holds it, m.
    """
    p = np.zeros(PARAMETERS)
    p[A_MAX], p[ALPHA_MAX], p[V_MAX], p[W_MAX] = (
        limits.a_max, limits.alpha_max, limits.v_max, limits.w_max
    )  # fmt: skip
    p[HORIZON], p[TURN_TIME], p[RADIUS], p[REACH] = spec.horizon, spec.turn_time, radius, reach
    p[MARGIN], p[COMFORT], p[GROWTH] = spec.margin, spec.comfort, spec.margin_growth
    p[PROGRESS], p[HEADING], p[CLEARANCE] = spec.progress, spec.heading, spec.clearance
    p[IMPACT], p[SMOOTHNESS] = spec.impact, spec.smoothness
    return p
