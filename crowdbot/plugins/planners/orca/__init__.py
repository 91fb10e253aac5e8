"""Optimal reciprocal collision avoidance of a robot."""
