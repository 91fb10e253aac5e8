"""Robots: CuyBot, Pepper, Qolo, Smart Wheelchair, TurtleBot2, and those with a URDF."""
