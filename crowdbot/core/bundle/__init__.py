"""Submission bundles: a campaign's scores in one archive that others can check and rank."""
