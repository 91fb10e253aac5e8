"""Runs on disk: what decides their identity, their directories and their records."""
