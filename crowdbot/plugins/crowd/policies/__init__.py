"""Crowd policies: how people decide where to walk."""
