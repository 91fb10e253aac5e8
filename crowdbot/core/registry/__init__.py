"""The registry: which plugins are installed, and what they provide."""
