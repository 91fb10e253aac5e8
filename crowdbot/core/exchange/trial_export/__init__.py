"""Write scenarios as trials of the original CrowdBot simulator; report what is lost."""
