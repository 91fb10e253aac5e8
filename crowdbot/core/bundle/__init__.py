"""Submission bundles: a campaign's scores in one archive that can be checked and ranked."""
