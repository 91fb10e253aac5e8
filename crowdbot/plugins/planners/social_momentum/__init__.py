"""Social Momentum: a robot that shows early on which side it will pass."""
