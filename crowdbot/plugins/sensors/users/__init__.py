"""Synthetic users: what drives a robot with a joystick in place of a person."""
