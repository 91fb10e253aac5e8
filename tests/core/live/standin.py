"""A stand-in for a navigation stack: pure pursuit from /map, /tf, /scan, /odom and /clock alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

#: Topics that it hears, with their types; nothing else, as a robot of ROS would.
HEARS = {
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/odom": "nav_msgs/msg/Odometry",
    "/clock": "rosgraph_msgs/msg/Clock",
}
_NEAR, _SPEED = 0.6, 0.5  # m, m/s


@dataclass
class PurePursuit:
    """Follows the middle of the free floor of the map to its far end.

    Attributes:
        aside: distance from the middle to the left, m.
        robot: name of the robot, which its topics and frames begin with; empty for the only one.
    """

    aside: float = 0.0
    robot: str = ""
    lane: float | None = None
    pose: tuple[float, float, float] | None = None
    speed: float = 0.0
    nearest: float = math.inf
    seen: set[str] = field(default_factory=set)

    def on_map(self, bottom: float, height: int, cell: float) -> None:
        self.seen.add("/map")
        self.lane = bottom + 0.5 * height * cell + self.aside

    def topic(self, name: str) -> str:
        """Name of a topic: with the robot's name, unless all robots share it."""
        shared = name in ("/map", "/tf", "/clock") or not self.robot
        return name if shared else f"/{self.robot}{name}"

    def on_tf(self, parent: str, child: str, x: float, y: float, z: float, w: float) -> None:
        before = f"{self.robot}/" if self.robot else ""
        if (parent, child) == (f"{before}odom", f"{before}base_footprint"):
            self.seen.add("/tf")
            self.pose = x, y, 2.0 * math.atan2(z, w)

    def on_odom(self, speed: float) -> None:
        self.seen.add("/odom")
        self.speed = speed

    def on_scan(self, ranges: list[float]) -> None:
        """Nearest thing in the middle third of the beams."""
        self.seen.add("/scan")
        third = len(ranges) // 3
        self.nearest = min(ranges[third:-third], default=math.inf)

    def command(self) -> tuple[float, float]:
        """v and w towards a point 2 m ahead on the lane; slower the nearer something is."""
        if self.pose is None or self.lane is None:
            return 0.0, 0.0
        _, y, yaw = self.pose
        turn = math.remainder(math.atan2(self.lane - y, 2.0) - yaw, math.tau)
        v = _SPEED * min(max(self.nearest - _NEAR, 0.0), 1.0)
        return v, 1.5 * turn
