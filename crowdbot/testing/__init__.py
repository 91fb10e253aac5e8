"""Checks that crowdbot's own components pass, for authors of other ones."""
