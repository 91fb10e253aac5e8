"""Cost functions over candidate velocities."""
