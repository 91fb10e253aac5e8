"""Meshes for people: read from glTF, one for each phase of a walk."""
