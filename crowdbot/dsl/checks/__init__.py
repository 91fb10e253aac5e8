"""Checks of a scenario beyond types, with source positions."""
