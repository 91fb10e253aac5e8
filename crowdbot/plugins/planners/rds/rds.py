"""RDS: the motion of a point ahead of the axle that keeps the whole outline clear."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, NonNegativeLength, PositiveDuration, PositiveLength, default
from crowdbot.plugins.planners.shared.rungs import RungSpec


class RdsSpec(RungSpec):
    """The robot does all of each evasion by itself; if no velocity avoids all, it brakes."""

    kind: Literal["rds"] = "rds"
    wish: Literal["goal", "user"] = default(
        "goal",
        "Whose velocity it stays near to: its own towards the goal, or that of the "
        "user at the joystick, as reactive assistance.",
    )
    time_horizon: PositiveDuration = default(1.5, "Time for which nothing is touched, s.")
    margin: NonNegativeLength = default(0.05, "Clearance that is kept to everything, m.")
    reference_point: PositiveLength = default(
        0.18,
        "Distance ahead of the axle of the point whose velocity is chosen, m; the "
        "shape that is kept clear reaches at least as far ahead of the axle as if this point were "
        "the centre of its front.",
    )
    basis: Literal["motion", "rest"] = default(
        "motion",
        "Velocity around which the half-planes lie: the robot's own, as in the "
        "publication's comparison with ORCA, or rest, as on the authors' robot, where standing "
        "still is always allowed.",
    )

    @property
    def wants(self) -> tuple[str, ...]:
        """Return the near sensors, if used, and the joystick, if it assists a user."""
        return (*super().wants, *(("joystick",) if self.wish == "user" else ()))


RDS = Component(
    spec=RdsSpec,
    summary="reactive driving support, for long robots (Gonon, Paez-Granados, Billard 2021)",
)
