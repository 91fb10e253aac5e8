"""Images of cameras: depth, and colour drawn by VTK."""
