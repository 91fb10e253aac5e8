"""Planners: their interface, how they are found, and the host that calls them."""
