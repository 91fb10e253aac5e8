"""Population: sample spawns and flows to a frozen table of agents."""
