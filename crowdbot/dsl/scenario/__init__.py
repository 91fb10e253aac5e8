"""The scenario model and its parts: crowd, streams, spawns, steering, routing."""
