"""Model-predictive control among people whom the crowd engine predicts on board."""
