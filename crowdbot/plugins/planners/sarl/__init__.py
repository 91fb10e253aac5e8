"""Socially attentive reinforcement learning: a value network with attention."""
