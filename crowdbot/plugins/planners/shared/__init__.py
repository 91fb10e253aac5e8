"""Shared parts of planners: points, people and their motion, the robot's size and heading."""
