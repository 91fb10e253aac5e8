"""Meshes for people."""
