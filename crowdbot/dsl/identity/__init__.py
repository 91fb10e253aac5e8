"""Canonical form and content hashes."""
