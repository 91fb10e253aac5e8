"""First commands: check the machine, read the documentation, list and check scenarios."""
