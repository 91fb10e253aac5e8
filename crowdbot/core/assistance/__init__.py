"""Tasks whose goals are people: the person, the robot's place beside it, the end of the task."""
