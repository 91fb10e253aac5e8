"""Tasks whose goals are people: who it is, where the robot's place is, when the task is done."""
