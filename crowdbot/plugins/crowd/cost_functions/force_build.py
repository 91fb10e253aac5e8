"""Forces as costs: C(u) = |u - target|^2 / (2 dt), the target being the force's effect in dt.

``prepare`` of a force-based function writes its target velocity to row 0 with `aim`; the rest is
the same for all of them.
"""

from __future__ import annotations

import math

from crowdbot.core.support.compile import array_kernel
from crowdbot.plugin import (
    BASE,
    EXCESS,
    GRADIENT,
    OPTIMUM,
    PARITY,
    TIME_STEP,
    VX,
    VY,
    WEIGHT,
    Pointer,
    declared_kernel,
)

#: No force is larger, m/s^2: a target has to stay finite when squared.
_LARGEST = 1e9


@array_kernel
def aim(fx: float, fy: float, agent: Pointer, work: Pointer) -> int:
    """Write the target velocity of a force per mass (m/s^2)."""
    size = math.hypot(fx, fy)
    if size > _LARGEST:
        fx, fy = fx / size * _LARGEST, fy / size * _LARGEST
    time = agent[TIME_STEP] / (agent[WEIGHT] if agent[PARITY] != 0.0 else 1.0)
    work[0], work[1] = agent[VX] + fx * time, agent[VY] + fy * time
    return 1


@declared_kernel(BASE)
def no_base(ux: float, uy: float, preferred: float, max_speed: float, params: Pointer) -> float:
    """Nothing depends on the candidate alone."""
    return 0.0


@declared_kernel(EXCESS)
def from_target(
    ux: float, uy: float, budget: float, agent: Pointer, work: Pointer, params: Pointer
) -> float:
    """The whole cost."""
    return float(0.5 * ((ux - work[0]) ** 2 + (uy - work[1]) ** 2) / agent[TIME_STEP])


@declared_kernel(GRADIENT)
def to_target(
    ux: float, uy: float, agent: Pointer, work: Pointer, params: Pointer, out: Pointer
) -> int:
    """Its gradient; at the present velocity minus the force per mass."""
    out[0], out[1] = (ux - work[0]) / agent[TIME_STEP], (uy - work[1]) / agent[TIME_STEP]
    return 1


@declared_kernel(OPTIMUM)
def target(agent: Pointer, work: Pointer, params: Pointer, out: Pointer) -> int:
    """The velocity of least cost."""
    out[0], out[1] = work[0], work[1]
    return 1
