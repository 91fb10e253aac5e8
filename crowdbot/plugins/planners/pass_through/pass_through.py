"""Pass-through: executes the user's command unchanged."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import Component, PlannerSpec


class PassThroughSpec(PlannerSpec):
    """Executes the user's command: the condition without assistance."""

    needs: ClassVar[tuple[str, ...]] = ("joystick",)

    kind: Literal["pass_through"] = "pass_through"


PASS_THROUGH = Component(spec=PassThroughSpec, summary="what the user asks for, without assistance")
