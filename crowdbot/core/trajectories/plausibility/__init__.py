"""Implausible recordings: units, headings, frames, times and jumps."""
