"""A person in a run through a page in the browser: at a robot's stick, or walking in the crowd."""
