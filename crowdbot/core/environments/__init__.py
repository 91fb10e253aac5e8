"""Environments: plain geometry, built from specs and checked."""
