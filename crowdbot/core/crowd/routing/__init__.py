"""Global paths: how people find their way around walls, and around each other where it is full."""
