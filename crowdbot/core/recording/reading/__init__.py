"""Recordings read back: runs, scans, images, commands, and what else is in a file."""
