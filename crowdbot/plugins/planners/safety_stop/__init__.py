"""Safety stop: the user's command, slowed down where the robot could not stop in time."""
