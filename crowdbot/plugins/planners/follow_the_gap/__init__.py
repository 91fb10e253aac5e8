"""Steer into the widest gap, less the farther the nearest obstacle."""
