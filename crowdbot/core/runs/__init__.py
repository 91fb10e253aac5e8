"""Runs on disk: their identity, directories and records."""
