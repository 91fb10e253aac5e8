"""People tracker for planners: legs in lidar points, a map of what stands, tracks of people."""
