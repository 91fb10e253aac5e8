"""Scoring: the contract of metrics, how runs are scored, and the table of scores."""
