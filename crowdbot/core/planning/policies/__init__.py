"""Trained policies as planners: files of weights, with what they observe and how they act."""
