"""Sweeps: parameters of a planner as axes, tried on people that no edition uses."""
