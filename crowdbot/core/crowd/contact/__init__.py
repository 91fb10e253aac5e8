"""Contact: forces between people, and between people and robots.

- `pedestrian_contact`: pushes between people who overlap, walls and pillars.
- `robot_contact`: forces between a robot and people.
- `geometry`: nearest points, and times until discs and walls touch.
"""
