"""Weights of learned planners, read from files that may be hostile."""
