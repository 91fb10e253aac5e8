"""Commands that compare planners and crowds."""
