"""Studies with people: orders of conditions, drives, questionnaires, and their results."""
