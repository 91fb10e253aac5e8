"""Steer into the widest gap, more strongly near obstacles."""
