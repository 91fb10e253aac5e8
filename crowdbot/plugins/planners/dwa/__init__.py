"""The dynamic window approach in the textbook's parts; ``dead_ends`` has what long robots add."""
