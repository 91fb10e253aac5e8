"""Model-predictive control among predicted people."""
