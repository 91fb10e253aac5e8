"""Robots: build and check the model of a spec, and read robot descriptions."""
