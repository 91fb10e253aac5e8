"""The machinery: registry, realisation, crowd engine, sensing, trajectories, recording, scores.

Only `crowdbot.core.sim` knows Drake.
"""
