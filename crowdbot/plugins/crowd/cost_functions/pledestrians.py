"""PLEdestrians: the principle of least effort.

Source: Guy, Chhugani, Curtis, Dubey, Lin, Manocha, "PLEdestrians: a least-effort approach to
crowd simulation", SCA 2010, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Gt

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    PositiveDuration,
    default,
)
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class PledestriansSpec(WeightedCostSpec):
    """Least metabolic energy to the goal without an early collision."""

    kind: Literal["pledestrians"] = "pledestrians"
    w_a: Annotated[float, Gt(0)] = default(2.23, "Power of standing, W/kg.")
    w_b: Annotated[float, Gt(0)] = default(
        1.26, "Power of walking per squared speed, W s^2/(kg m^2)."
    )
    t_min: NonNegativeDuration = default(0.5, "Collisions sooner than this are forbidden, s.")
    t_max: PositiveDuration = default(3.0, "How long the velocity is kept in the plan, s.")


PLEDESTRIANS = Component(
    spec=PledestriansSpec,
    summary="least effort to the goal (Guy et al. 2010)",
)
