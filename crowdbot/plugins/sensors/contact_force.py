"""Contact force: the force of people on the robot, as a soft skin or force bumper measures it."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, Mount, PositiveForce, PositiveFrequency, SensorSpec, default


class ContactForceSpec(SensorSpec):
    """Reading: force x, y (N) and torque about z (N m), in the axes of the mount and about it.

    The sum over all people in contact, at any place. Walls are not sensed.
    """

    kind: Literal["contact_force"] = "contact_force"
    mount: Mount = default(Mount(), "Pose on the robot; x, y and yaw count.")
    rate: PositiveFrequency = default(128.0, "Readings per second, Hz.", le=128)
    noise: float = default(0.0, "Standard deviation of each force, N; of the torque, N m.", ge=0)
    force_max: PositiveForce = default(
        1000.0, "Larger forces are measured as this, in their direction, N."
    )


CONTACT_FORCE = Component(
    spec=ContactForceSpec,
    summary="force and torque with which people push the robot",
)
