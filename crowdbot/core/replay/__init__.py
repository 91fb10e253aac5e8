"""Replay page."""
