"""Behaviours of the library navground, for comparison."""
