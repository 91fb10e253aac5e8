"""Planners in processes of their own: the processes, the messages, and what is known of them."""
