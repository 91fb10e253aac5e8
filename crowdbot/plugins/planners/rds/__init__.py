"""Reactive driving support: half-planes for robots that are long and cannot go sideways."""
