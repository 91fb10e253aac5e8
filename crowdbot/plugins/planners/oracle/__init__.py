"""Oracle: plans with the truth, people foreseen included."""
