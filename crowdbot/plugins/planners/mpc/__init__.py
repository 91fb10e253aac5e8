"""Nonlinear model-predictive control, solved by CasADi."""
