"""Cohesion of groups: the forces of Moussaïd et al. 2010, as a spec."""

from __future__ import annotations

import math
from typing import Annotated

from annotated_types import Ge, Gt, Le

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import PositiveAcceleration, PositiveLength, Quantity
from crowdbot.dsl.spec.spec import Spec

Strength = Annotated[float, Ge(0), Le(100)]


class GroupForces(Spec):
    """Accelerations that hold groups together, added to those of any policy.

    Source of strengths, angle and distance: Moussaïd et al., PLoS ONE 5(4), 2010, e10047.
    """

    gaze: Strength = default(
        4.0, "β1, 1/s: slows down people who would have to turn the head to see the others."
    )
    cohesion: Strength = default(3.0, "β2, m/s^2: towards the middle of the group.")
    repulsion: Strength = default(1.0, "β3, m/s^2: away from members that are too near.")
    field_of_view: Annotated[float, Gt(0), Le(math.tau), Quantity("angle")] = default(
        math.pi, "Full angle in which the middle of the group is seen without turning, rad."
    )
    distance: PositiveLength = default(0.8, "Members whose centres are nearer repel each other, m.")
    limit: PositiveAcceleration = default(
        3.0, "Largest acceleration by all three together, m/s^2; ours."
    )
