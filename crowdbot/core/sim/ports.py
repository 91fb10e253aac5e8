"""Names and sizes of the ports between the blocks of the diagram."""

from __future__ import annotations

#: x, y, yaw, vx, vy, w, tilt, z, left and right wheel angle; world frame, SI.
ROBOT_STATE, ROBOT_STATE_SIZE = "robot_state", 10
#: The flat vector of `crowdbot.core.crowd.state`.
CROWD_STATE = "crowd_state"
#: Number of trips, and of contacts with the robot, that have ended.
EVENTS = "events"
#: Generalised force on the plant's velocities, N m and N.
ROBOT_FORCE = "robot_force"
#: Latest readings of all sensors, in the order of the sensor bank.
READINGS = "readings"
#: Wheel rates left, right (rad/s) as the plant's desired state [0, 0, left, right].
DESIRED_STATE, DESIRED_STATE_SIZE = "desired_state", 4
#: Tick, the planner's command v (m/s) and w (rad/s), the same two after slew limits.
COMMAND, COMMAND_SIZE = "command", 5
