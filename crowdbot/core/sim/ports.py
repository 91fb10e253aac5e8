"""Names and sizes of the diagram's ports."""

from __future__ import annotations

#: The fields of `RobotState`; world frame, SI.
ROBOT_STATE, ROBOT_STATE_SIZE = "robot_state", 11
#: The flat vector of `crowdbot.core.crowd.state`.
CROWD_STATE = "crowd_state"
#: Number of trips, and of contacts with each robot, that have ended.
EVENTS = "events"
#: Force of people on the robot, in the control mode's layout (`crowdbot.core.sim.control`).
ROBOT_FORCE = "robot_force"
#: Latest readings of all sensors, in the order of the sensor bank.
READINGS = "readings"
#: The control mode's input from a command.
DESIRED_STATE = "desired_state"
#: Tick, the planner's command v (m/s), w (rad/s), vy (m/s), and the same three after slew limits.
COMMAND, COMMAND_SIZE = "command", 7
#: Drake's contact results of the plant.
FORCES = "forces"
#: Force x, y (N, world frame) and torque (N m) of other robots on a robot.
ROBOT_PUSH, ROBOT_PUSH_SIZE = "robot_push", 3


def other_robot(number: int) -> tuple[str, int]:
    """Return name and size of the port of another robot's state."""
    return f"other_{ROBOT_STATE}_{number}", ROBOT_STATE_SIZE


def of_robot(port: str, number: int) -> str:
    """Return the name of a port for one robot of several."""
    return f"{port}_{number}"
