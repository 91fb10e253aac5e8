"""Probabilistic shared control."""
