"""UMANS: the XML of the original's crowd engine, and the trajectories that it writes."""
