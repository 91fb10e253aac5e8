"""Path finding of people around walls, and around each other in congestion."""
