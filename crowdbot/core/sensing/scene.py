"""Scene: what sensors see at one instant."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.interfaces import RobotState
from crowdbot.core.sensing.raycast import cast_rays

Array = NDArray[np.float64]


def _constant(values: ArrayLike, shape: tuple[int, ...]) -> Array:
    array = np.ascontiguousarray(np.broadcast_to(np.asarray(values, dtype=np.float64), shape))
    array = array.copy()
    array.setflags(write=False)
    return array


class Scene:
    """Walls, pillars, people as upright cylinders, and the robot; world frame, SI.

    Built once. `update` keeps views, no copies: whoever owns the arrays may go on changing them
    in place, and the scene follows. The robot's own body is never hit.

    Attributes:
        walls: (S, 4) segments x0, y0, x1, y1, m.
        wall_heights: (S, 2) bottom and top, m.
        people_radius, people_height: (M,) m.
        pillars: (P, 3) x, y, radius of round obstacles that stand on the floor, m.
        pillar_heights: (P,) m.
        robot: the robot's state, None before the first update or in a scene without one.
        people: (M, 4) x, y (m), vx, vy (m/s), a read-only view.
        present: (M,) bool, who is in the world, a read-only view.
    """

    def __init__(
        self,
        walls: ArrayLike,
        wall_heights: ArrayLike,
        people_radius: ArrayLike,
        people_height: ArrayLike,
        pillars: ArrayLike = (),
        pillar_heights: ArrayLike = (),
    ) -> None:
        self.walls = _constant(np.reshape(walls, (-1, 4)), (np.size(walls) // 4, 4))
        self.wall_heights = _constant(wall_heights, (len(self.walls), 2))
        count = np.size(people_radius)
        self.people_radius = _constant(people_radius, (count,))
        self.people_height = _constant(people_height, (count,))
        self.pillars = _constant(np.reshape(pillars, (-1, 3)), (np.size(pillars) // 3, 3))
        self.pillar_heights = _constant(pillar_heights, (len(self.pillars),))
        self.robot: RobotState | None = None
        self.people: Array = _constant(0.0, (count, 4))
        self.present: NDArray[np.bool_] = np.zeros(count, dtype=np.bool_)
        self.present.setflags(write=False)

    def update(
        self, robot_state: RobotState | None, people_xyv: Array, present: NDArray[np.bool_]
    ) -> None:
        """Show another instant.

        Args:
            robot_state: where the robot is and how it moves.
            people_xyv: (M, 4) float64 x, y (m), vx, vy (m/s); kept as a view.
            present: (M,) bool, who is in the world; kept as a view.

        Raises:
            ValueError: a shape or a type does not fit.
        """
        count = len(self.people_radius)
        if people_xyv.shape != (count, 4) or people_xyv.dtype != np.float64:
            raise ValueError(f"people must be float64 ({count}, 4), not {people_xyv.shape}")
        if present.shape != (count,) or present.dtype != np.bool_:
            raise ValueError(f"present must be bool ({count},), not {present.shape}")
        self.robot = robot_state
        self.people = people_xyv.view()
        self.people.setflags(write=False)
        self.present = present.view()
        self.present.setflags(write=False)

    def cast(
        self, origins: Array, directions: Array, max_range: float
    ) -> tuple[Array, Array, NDArray[np.int64]]:
        """Nearest hit of each ray on a wall, a pillar or a person.

        Fast for consecutive rays with equal origins. An origin inside a person's cylinder, or on
        its surface, hits that person at distance 0 with incidence 0.

        Args:
            origins: (R, 3) world frame, m.
            directions: (R, 3) world frame; any length but zero.
            max_range: m; hits beyond it do not count.

        Returns:
            distance (R,) m, inf without a hit; incidence (R,) angle to the surface normal, rad, 0
            without a hit; body (R,) int64, a person's index, -(2 + index) of a wall, -1 for none;
            pillars count on after the walls.
        """
        hits = cast_rays(
            origins,
            directions,
            max_range,
            self.walls,
            self.wall_heights,
            self.people,
            self.present,
            self.people_radius,
            self.people_height,
        )
        return hits if not len(self.pillars) else self._nearer(hits, origins, directions, max_range)

    def _nearer(
        self,
        hits: tuple[Array, Array, NDArray[np.int64]],
        origins: Array,
        directions: Array,
        max_range: float,
    ) -> tuple[Array, Array, NDArray[np.int64]]:
        """Hits on pillars where they are nearer: to rays they are people who stand."""
        count = len(self.pillars)
        distance, incidence, body = cast_rays(
            origins,
            directions,
            max_range,
            self.walls[:0],
            self.wall_heights[:0],
            np.column_stack([self.pillars[:, :2], np.zeros((count, 2))]),
            np.ones(count, np.bool_),
            np.ascontiguousarray(self.pillars[:, 2]),
            self.pillar_heights,
        )
        nearer = distance < hits[0]
        number = -(2 + len(self.walls) + body)
        return (
            np.where(nearer, distance, hits[0]),
            np.where(nearer, incidence, hits[1]),
            np.where(nearer, number, hits[2]),
        )
