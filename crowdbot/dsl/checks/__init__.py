"""Checks of a scenario beyond types, with positions."""
