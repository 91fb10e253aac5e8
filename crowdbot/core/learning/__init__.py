"""Input of learned policies: observations as vectors, and rewards.

A batch of worlds, in which a policy is trained, and a planner, with which it is judged, get the
same observation.
"""
