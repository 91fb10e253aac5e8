"""Safety stop: the command of the user, with brakes."""
