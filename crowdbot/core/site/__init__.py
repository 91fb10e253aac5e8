"""The site of a challenge: one folder of offline pages that an organiser publishes."""
