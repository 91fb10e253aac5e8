"""Blocks that write a run down, and the logs that they write to."""
