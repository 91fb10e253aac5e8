"""Rewards for training policies."""
