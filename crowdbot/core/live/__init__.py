"""Live runs: external programs drive the robot of a run, through their own protocols."""
