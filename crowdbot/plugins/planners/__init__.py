"""Planners: floors (blind or only stopping), baselines, a ceiling, adversaries, shared control."""
