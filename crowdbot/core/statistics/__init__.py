"""Statistics of campaigns: the better planner, by how much, and with what certainty.

Works on `crowdbot.core.results.results.Results` alone: no store, no simulator, no page.
docs/explanation/statistics.md says what is computed and how to read it.
"""
