"""Social Momentum: pass people on the side that is already likely, and show it early."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from crowdbot.plugin import Component, NonNegativeLength, PositiveDuration, PositiveLength, default
from crowdbot.plugins.planners.shared.rungs import RungSpec


class SocialMomentumSpec(RungSpec):
    """Mavrogiannis, Thomason, Knepper 2018. The paper leaves all values to the user."""

    kind: Literal["social_momentum"] = "social_momentum"
    momentum: Annotated[float, Ge(0)] = default(
        0.2, "Weight of the momentum beside progress, 1/m; 0: only progress."
    )
    horizon: PositiveDuration = default(
        2.0, "Velocities that touch something earlier are not chosen, s."
    )
    reach: PositiveLength = default(5.0, "People ahead who are farther away play no part, m.")
    directions: int = default(
        31, "Directions to choose from, over the half circle ahead.", ge=5, le=181
    )
    safety: NonNegativeLength = default(0.05, "Least distance between robot and obstacle, m.")


SOCIAL_MOMENTUM = Component(
    spec=SocialMomentumSpec,
    summary="shows early on which side it will pass (Mavrogiannis, Thomason, Knepper 2018)",
)
