"""Build the response of a world from the field ``crowd.robot_response``."""

from __future__ import annotations

from dataclasses import fields

from crowdbot.core.crowd.response.parameters import Human
from crowdbot.dsl.scenario.robot_response import RobotResponse


def response_of(spec: RobotResponse) -> Human:
    """Return the response that a spec describes; units are those of its fields."""
    given = {f.name: getattr(spec, f.name) for f in fields(Human) if hasattr(spec, f.name)}
    if not getattr(spec, "hears", True):
        given["hearing_time"] = 0.0
    return Human(**given)
