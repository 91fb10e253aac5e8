"""What a world takes as a response, from the field ``crowd.robot_response``."""

from __future__ import annotations

from dataclasses import fields

from crowdbot.core.crowd.response.parameters import Human, KeepOff, Response
from crowdbot.dsl.scenario.robot_response import KeepOffResponse, RobotResponse


def response_of(spec: RobotResponse) -> Response:
    """The response that a spec describes; units are those of its fields."""
    made = KeepOff if isinstance(spec, KeepOffResponse) else Human
    return made(**{f.name: getattr(spec, f.name) for f in fields(made)})
