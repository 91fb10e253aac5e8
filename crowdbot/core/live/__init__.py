"""Live runs: external programs drive the robots of a run, through their own protocols."""
