"""Compressed motion of people: samples as messages, and the predictive codec."""
