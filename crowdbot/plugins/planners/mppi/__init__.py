"""Model-predictive path integral control."""
