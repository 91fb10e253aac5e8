"""Arguments and options of ``crowdbot serve``."""
