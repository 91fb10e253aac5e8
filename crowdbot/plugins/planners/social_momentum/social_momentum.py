"""Social Momentum: pass people on the side that is already likely, and show it early."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, NonNegativeLength, PositiveDuration, PositiveLength
from crowdbot.plugins.planners.shared.rungs import RungSpec


class SocialMomentumSpec(RungSpec):
    """Mavrogiannis, Thomason, Knepper 2018. The paper leaves all values to the user."""

    kind: Literal["social_momentum"] = "social_momentum"
    momentum: Annotated[float, Ge(0)] = Field(
        default=0.2, description="Weight of the momentum beside progress, 1/m; 0: only progress."
    )
    horizon: PositiveDuration = Field(
        default=2.0, description="Velocities that touch something earlier are not chosen, s."
    )
    reach: PositiveLength = Field(
        default=5.0, description="People ahead who are farther away play no part, m."
    )
    directions: int = Field(
        default=31,
        ge=5,
        le=181,
        description="Directions to choose from, over the half circle ahead.",
    )
    safety: NonNegativeLength = Field(
        default=0.05, description="Least distance between robot and obstacle, m."
    )


SOCIAL_MOMENTUM = Component(
    spec=SocialMomentumSpec,
    summary="shows early on which side it will pass (Mavrogiannis, Thomason, Knepper 2018)",
)
