"""Social Momentum: a planner that shows early on which side the robot will pass."""
