"""Live: programs outside drive the robot of a run, through the protocols that they speak."""
