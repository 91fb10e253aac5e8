"""Export scenarios as trials of the original CrowdBot simulator, with a report of losses."""
