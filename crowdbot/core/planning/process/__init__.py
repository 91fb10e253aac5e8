"""Planners in separate processes: the processes, their messages, and descriptions."""
