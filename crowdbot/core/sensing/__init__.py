"""What sensors see, their random numbers, and lidar points for planners."""
