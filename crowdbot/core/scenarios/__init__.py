"""Scenarios: the library of suites, and their locks."""
