from typing import ClassVar, Literal

from pydantic import Field

from crowdbot.plugin import Component, PlannerSpec, PositiveLength


class WaiterSpec(PlannerSpec):
    """Drives to the goal and waits while anything is near."""

    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["careful.waiter"] = "careful.waiter"
    gap: PositiveLength = Field(default=0.8, description="It waits if anything is nearer, m.")


WAITER = Component(
    spec=WaiterSpec,
    build="crowdbot_careful.waiter_build:build",
    summary="to the goal, waits while anything is near",
    examples=({}, {"gap": "40 cm"}),
)
