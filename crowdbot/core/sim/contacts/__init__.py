"""Contacts of robots with walls and with each other, and what pushes a robot."""
