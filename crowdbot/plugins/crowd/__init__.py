"""Crowd policies and the cost functions they minimise."""
