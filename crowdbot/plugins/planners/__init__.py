"""Planners: floors that see nothing or only stop, a baseline that finds a way, and a ceiling."""
