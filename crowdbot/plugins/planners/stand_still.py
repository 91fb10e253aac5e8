"""Stand still: never collides and never arrives."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import Component, PlannerRole, PlannerSpec


class StandStillSpec(PlannerSpec):
    """Never moves. A planner that scores no better is safe only because it does not do its task."""

    role: ClassVar[PlannerRole] = "floor"
    needs: ClassVar[tuple[str, ...]] = ()

    kind: Literal["stand_still"] = "stand_still"


STAND_STILL = Component(spec=StandStillSpec, summary="never moves")
