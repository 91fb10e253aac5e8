"""Views of policies that learn: observations as vectors, and rewards.

The same observation is made in a batch of worlds, where a policy is trained, and of what a planner
sees, where it is judged.
"""
