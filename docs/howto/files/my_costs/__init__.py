"""Two costs of walking: near others' backs, and fast beside walls."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge
from pydantic import Field

from crowdbot.plugin import Component, CostFunctionSpec, PositiveLength, hookimpl


class ElbowRoomSpec(CostFunctionSpec):
    """Keeps away from where others are about to be."""

    kind: Literal["my_costs.elbow_room"] = "my_costs.elbow_room"
    weight: Annotated[float, Ge(0)] = Field(default=1.0, description="Factor of the cost.")
    range: PositiveLength = Field(default=3.0, description="People farther away do not count, m.")


class QuickElbowRoomSpec(ElbowRoomSpec):
    """The same, compiled."""

    kind: Literal["my_costs.quick_elbow_room"] = "my_costs.quick_elbow_room"  # type: ignore[assignment]


ELBOW_ROOM = Component(
    spec=ElbowRoomSpec, build="my_costs.numpy_build:build", summary="keeps a distance"
)
QUICK_ELBOW_ROOM = Component(
    spec=QuickElbowRoomSpec,
    build="my_costs.compiled_build:build",
    summary="keeps a distance, compiled",
)


@hookimpl
def crowdbot_components() -> dict[str, list[Component[CostFunctionSpec]]]:
    return {"cost function": [ELBOW_ROOM, QUICK_ELBOW_ROOM]}
