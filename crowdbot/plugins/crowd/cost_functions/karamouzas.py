"""Karamouzas: the predicted collision limits the velocities considered.

Source: Karamouzas, Overmars, "A velocity-based approach for simulating human collision
avoidance", IVA 2010, in the form of van Toll et al., I3D 2020.
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, PositiveDuration, default
from crowdbot.plugins.crowd.cost_functions.weighted_cost import WeightedCostSpec


class KaramouzasSpec(WeightedCostSpec):
    """Least effort among velocities whose deviation fits the time left before a collision."""

    kind: Literal["karamouzas"] = "karamouzas"
    alpha: Annotated[float, Ge(0)] = default(5.0, "Weight of the deviation in heading.")
    beta: Annotated[float, Ge(0)] = default(0.5, "Weight of the change of speed.")
    gamma: Annotated[float, Ge(0)] = default(1.0, "Weight of the deviation in velocity.")
    delta: Annotated[float, Ge(0)] = default(1.0, "Weight of the time to collision.")
    t_max: PositiveDuration = default(8.0, "Collisions later than this cost nothing, s.")


KARAMOUZAS = Component(
    spec=KaramouzasSpec,
    summary="least effort within allowed deviations (Karamouzas and Overmars 2010)",
)
