"""Ways out for a robot that comes no farther: a small map, and manoeuvres of long robots."""
