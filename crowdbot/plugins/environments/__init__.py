"""Environments: corridors, halls, streets, floors and floor plans."""
