"""DWA, the dynamic window approach, in its textbook parts; ``dead_ends`` is for stuck robots."""
