"""Swerve: to the goal, slower and to the side when a person is near."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import Component, PlannerSpec, PositiveFrequency, PositiveLength
from pydantic import Field


class SwerveSpec(PlannerSpec):
    """Sees what ``acme.radar`` sees, nothing else; logs how hard it brakes."""

    needs: ClassVar[tuple[str, ...]] = ("radar",)

    kind: Literal["acme.swerve"] = "acme.swerve"
    stop: PositiveLength = Field(default=0.7, description="It stops if a person is nearer, m.")
    slow: PositiveLength = Field(default=2.0, description="It slows down from here on, m.")
    gain: PositiveFrequency = Field(default=2.0, description="Yaw rate per heading error, 1/s.")


SWERVE = Component(
    spec=SwerveSpec,
    build="crowdbot_acme.swerve_build:build",
    summary="to the goal, slower and to the side when a person is near",
)
