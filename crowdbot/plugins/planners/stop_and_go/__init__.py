"""Goal seek that stops for people."""
