"""Outside: a planner in a process of its own, in whatever language."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import MaxLen
from crowdbot.plugin import Component, PlannerSpec, PositiveDuration
from pydantic import Field


class OutsideSpec(PlannerSpec):
    """Speaks JSON, a line a message, over the process' standard input and output.

    A process that dies, answers nonsense or answers too late ends the run as ``planner_failed``:
    to stop the robot instead would make the result depend on how busy the machine was.
    """

    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["acme.outside"] = "acme.outside"
    command: Annotated[tuple[str, ...], MaxLen(64)] = Field(
        default=(),
        strict=False,
        description="Program and arguments; none is the one that comes with this package.",
    )
    budget: PositiveDuration = Field(
        default=2.0, description="Wall time for one answer, the first one excepted, s."
    )
    start_time: PositiveDuration = Field(
        default=20.0, description="Wall time for the first answer, s."
    )


OUTSIDE = Component(
    spec=OutsideSpec,
    build="crowdbot_acme.outside_build:build",
    summary="a planner in its own process, spoken to in JSON lines",
)
