"""The social force model as a robot's planner."""
