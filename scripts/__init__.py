"""Tools of those who work on crowdbot; none is part of the package."""
