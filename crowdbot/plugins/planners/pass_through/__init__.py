"""Pass-through: the command of the user."""
