"""Trajectories: what a run leaves behind for metrics, and what is computed from it."""
