"""Rewards of policies that learn."""
