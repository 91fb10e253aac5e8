"""Fault of the robot in its contacts with people."""
