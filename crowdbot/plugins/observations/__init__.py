"""Observations of policies that learn."""
