"""Metrics of the CrowdBot challenge (D7.3, sections 1.2 and 2.2) and from the literature."""
