"""Crowd policies: models of people's walking decisions."""
