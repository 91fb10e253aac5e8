"""Synthetic users: simulated people who drive a robot with a joystick."""
