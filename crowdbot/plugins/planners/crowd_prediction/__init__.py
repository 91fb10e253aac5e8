"""Model-predictive control among people who are predicted by the crowd engine."""
