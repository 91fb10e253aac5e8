"""People tracker for planners: leg detection in lidar points, static map, tracks of people."""
