"""Contacts of robots with walls and each other, and the forces that push a robot."""
