"""Planners: their contract, where they come from, and the host that calls them."""
