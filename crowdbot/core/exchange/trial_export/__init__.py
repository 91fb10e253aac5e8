"""Scenarios of ours as trials of the original, with a report of what they cannot say."""
