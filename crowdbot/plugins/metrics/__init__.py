"""To be filled."""
COMPONENTS = ()
