"""Adversaries: planners that try to score well without driving well."""
