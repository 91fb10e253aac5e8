"""To be filled."""

COMPONENTS = ()
