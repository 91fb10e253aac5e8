"""Sensing: simulation of sensors.

- `sensor`: the interfaces; `build` builds sensors and checks their readings.
- `scene`: walls, pillars and people at one instant; `body_model` gives people legs and a trunk.
- `raycast` casts single rays, `raycast_columns` grids of them (`ray_grid`), which it fills with
  bodies (`ray_columns`), and `raycast_tilted` those of tilted sensors.
- `depth_renderer` makes depth images, with `projection` and `depth`; `depth_mm` rounds them.
- `range_model`: converts true distances to readings; `noise`: random numbers of sensors.
- `mount`: pose of a sensor; `points`: lidar points for planners.
"""
