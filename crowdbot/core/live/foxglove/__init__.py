"""A live view in Foxglove."""
