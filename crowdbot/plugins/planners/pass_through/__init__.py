"""Pass-through: executes the user's command unchanged."""
