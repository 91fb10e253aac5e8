"""How large the robot is, for planners: what their spec says, else what the robot says."""

from __future__ import annotations

from crowdbot.core.interfaces import RobotBody

#: Of a TurtleBot2, m: for who tells a planner nothing of the robot.
ROBOT_RADIUS = 0.178


def disc_radius(told: float | None, body: RobotBody | None) -> float:
    """Radius of the smallest disc around the drive axis that holds the robot, m.

    Args:
        told: what the planner's spec says, m; None: nothing.
        body: what the robot says.
    """
    if told is not None:
        return told
    return ROBOT_RADIUS if body is None else body.reach


def half_width_and_front(told: float | None, body: RobotBody | None) -> tuple[float, float]:
    """How far the robot reaches to either side, and ahead, m; arguments as for `disc_radius`."""
    if told is not None or body is None:
        radius = disc_radius(told, body)
        return radius, radius
    return body.half_width, body.front
