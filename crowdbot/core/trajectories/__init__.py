"""Trajectories: the data of a run for metrics, and quantities computed from it."""
