"""The robot as a person of the crowd."""
