"""Contact force: the force of people on the robot, as a soft skin or force bumper measures it."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.plugin import Component, Mount, PositiveForce, PositiveFrequency, SensorSpec


class ContactForceSpec(SensorSpec):
    """Reading: force x, y (N) and torque about z (N m), in the axes of the mount and about it.

    The sum over all people in contact, at any place. Walls are not sensed.
    """

    kind: Literal["contact_force"] = "contact_force"
    mount: Mount = Field(default=Mount(), description="Pose on the robot; x, y and yaw count.")
    rate: PositiveFrequency = Field(default=128.0, le=128, description="Readings per second, Hz.")
    noise: float = Field(
        default=0.0, ge=0, description="Standard deviation of each force, N; of the torque, N m."
    )
    force_max: PositiveForce = Field(
        default=1000.0, description="Larger forces are measured as this, in their direction, N."
    )


CONTACT_FORCE = Component(
    spec=ContactForceSpec,
    summary="force and torque with which people push the robot",
)
