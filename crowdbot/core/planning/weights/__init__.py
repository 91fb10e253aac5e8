"""Weights of learned planners, read from untrusted files."""
