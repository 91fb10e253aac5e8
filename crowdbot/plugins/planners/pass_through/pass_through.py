"""Pass-through: the user alone."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import Component, PlannerSpec


class PassThroughSpec(PlannerSpec):
    """Does what the user asks for: the condition without assistance."""

    needs: ClassVar[tuple[str, ...]] = ("joystick",)

    kind: Literal["pass_through"] = "pass_through"


PASS_THROUGH = Component(spec=PassThroughSpec, summary="what the user asks for, without assistance")
