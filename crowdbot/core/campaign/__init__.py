"""Campaigns: suites × planners × seeds, in several processes, on one machine or many."""
