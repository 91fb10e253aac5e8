"""Scoring: the metric interface, scoring of runs, and the table of scores."""
