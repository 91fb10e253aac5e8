"""Collision avoidance with deep reinforcement learning: a value network of pairs."""
