"""Behaviours of the library navground, to compare ours with."""
