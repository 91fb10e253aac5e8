"""Noise generators of sensors."""
