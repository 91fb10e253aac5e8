"""Regulated pure pursuit."""
