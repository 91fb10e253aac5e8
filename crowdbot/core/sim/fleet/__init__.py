"""Several robots in one run, each with its own plant, sensors and planner, in one diagram."""
