"""Planner that decides like a person of the crowd."""
