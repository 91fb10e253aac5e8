"""Linear blending of the commands of user and planner."""
