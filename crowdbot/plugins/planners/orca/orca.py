"""ORCA: the velocity nearest to the wanted one that avoids everyone for some seconds."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from crowdbot.plugin import Component, NonNegativeLength, PositiveDuration, default
from crowdbot.plugins.planners.shared.rungs import RungSpec


class OrcaPlannerSpec(RungSpec):
    """People are assumed to do their share of each evasion; walls do nothing."""

    kind: Literal["orca"] = "orca"
    time_horizon: PositiveDuration = default(2.0, "Time for which no person is touched, s.")
    obstacle_horizon: PositiveDuration = default(
        1.0, "Time for which nothing that stands is touched, s."
    )
    share: Annotated[float, Gt(0), Le(1)] = default(
        0.5, "The robot's share of an evasion; 0.5: people take the other half."
    )
    neighbours: Annotated[int, Ge(1), Le(200)] = default(
        20, "People that are considered, the nearest first."
    )
    tracking_error: NonNegativeLength = default(
        0.05, "How far a robot that cannot go sideways may be off the chosen velocity, m."
    )


ORCA = Component(
    spec=OrcaPlannerSpec,
    summary="optimal reciprocal collision avoidance, non-holonomic (Alonso-Mora et al. 2013)",
)
