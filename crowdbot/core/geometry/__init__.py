"""Plane geometry: polygons, footprints, the optical frame of cameras."""
