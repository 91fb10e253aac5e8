"""Recovery of a robot without progress: a small map, and manoeuvres of long robots."""
