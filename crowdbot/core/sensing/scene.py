"""Scene: the surroundings of sensors at one instant."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crowdbot.core.sensing.appearance_model import gaits, heights, place_looks, place_things, things
from crowdbot.core.sensing.body_model import DISC_COLUMNS, PARTS, place_people
from crowdbot.core.sensing.depth_renderer import DepthRenderer
from crowdbot.core.sensing.other_robots import OtherRobot, RobotSurfaces
from crowdbot.core.sensing.ray_grid import Obstacles, RayGrid
from crowdbot.core.sensing.raycast import cast_rays
from crowdbot.core.sensing.raycast_columns import cast_columns
from crowdbot.core.sensing.raycast_tilted import cast_tilted_rays
from crowdbot.core.sensing.walls_near import WallsNear, in_scene
from crowdbot.core.support.immutable import immutable, immutable_fields
from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotState

#: In place of unneeded details.
_UNTOUCHED = (0.0, 0.0, 0.0)
_Shown = TypeVar("_Shown")
_NO_ANGLES, _NOBODY = np.empty((0, 0)), np.empty((0, 0), dtype=np.int64)


def _constant(values: ArrayLike, shape: tuple[int, ...]) -> Array:
    return immutable(np.broadcast_to(np.asarray(values, dtype=np.float64), shape))


def _have_one_origin(origins: Array) -> bool:
    return len(origins) > 0 and bool((origins[:, :2] == origins[0, :2]).all())


class Scene:
    """Walls, pillars, walking people, and the robot; world frame, SI.

    Built once. `update` keeps views, not copies: the owner may change the arrays in place until the
    first reading. The robot's own body is never hit. The scene's arrays are permanently read-only.

    Attributes:
        wall_heights: (S, 2) bottom and top of `walls`, m.
        people_radius, people_height: (M,) m.
        pillar_heights: (P, 2) bottom and top of `pillars`, m.
        fixed_walls, fixed_pillars: number of static ones; those after them are surfaces of other
            robots.
        looks: appearance of people; None: all default.
        others: the other robots of a fleet.
        things: (T, 6) people's objects, see `crowdbot.core.sensing.appearance_model`.
        robot: the robot's state, None before the first update or in a scene without one.
        push: force of people on the robot x, y (N, world frame), and its torque about the robot's
            base (N m), in the last tick.
    """

    def __init__(
        self,
        walls: ArrayLike,
        wall_heights: ArrayLike,
        people_radius: ArrayLike,
        people_height: ArrayLike,
        pillars: ArrayLike = (),
        pillar_heights: ArrayLike = (0.0, 2.5),
        looks: Appearance | None = None,
        robots: Sequence[OtherRobot] = (),
    ) -> None:
        self._walls = _constant(np.reshape(walls, (-1, 4)), (np.size(walls) // 4, 4))
        self.wall_heights = _constant(wall_heights, (len(self._walls), 2))
        self.fixed_walls = len(self._walls)
        count = np.size(people_radius)
        self.people_radius = _constant(people_radius, (count,))
        self.people_height = _constant(people_height, (count,))
        if looks is not None:
            looks = immutable_fields(looks)
            usual = float(self.people_height[0]) if count else 0.0
            self.people_height = _constant(heights(looks, usual), (count,))
        self.looks = looks
        self._gait = None if looks is None else gaits(looks, self.people_height)
        self.things = immutable(np.zeros((0, 6)) if looks is None else things(looks))
        self.robot: RobotState | None = None
        self.push: tuple[float, float, float] = _UNTOUCHED
        self._people: Array = _constant(0.0, (count, 4))
        self._present: NDArray[np.bool_] = immutable(np.zeros(count, dtype=np.bool_))
        self._direction, self._walked = _constant((1.0, 0.0), (count, 2)), _constant(0.0, (count,))
        self._pillars = _constant(np.reshape(pillars, (-1, 3)), (np.size(pillars) // 3, 3))
        self.pillar_heights = _constant(pillar_heights, (len(self._pillars), 2))
        self.fixed_pillars = len(self._pillars)
        self.others = RobotSurfaces(robots)
        if robots:
            self._make_room()
        self._obstacles = Obstacles(self._walls, self.wall_heights, *self._lay_out())
        self._near = WallsNear(self._walls, self.wall_heights, self.fixed_walls)
        self._placed = False
        self._shown: dict[str, Any] = {}

    def _make_room(self) -> None:
        """Reserve space for the surfaces of robots, after walls and pillars."""
        others = self.others
        self._plates = np.concatenate([self._walls, others.plates])
        self._rounds = np.concatenate([self._pillars, others.discs])
        # Views with the same type for kernels as in scenes without other robots.
        self._walls, self._pillars = self._plates.view(), self._rounds.view()
        for array in (self._walls, self._pillars):
            array.setflags(write=False)
        plates = np.concatenate([self.wall_heights, others.plate_heights])
        discs = np.concatenate([self.pillar_heights, others.disc_heights])
        self.wall_heights, self.pillar_heights = immutable(plates), immutable(discs)

    def show_robots(self, poses: Sequence[Pose | None]) -> None:
        """Move the other robots to their poses; a robot whose pose is None has left."""
        self.others.place(poses)
        self._plates[self.fixed_walls :] = self.others.plates
        self._rounds[self.fixed_pillars :] = self.others.discs
        first = PARTS * len(self.people_radius)
        discs = self._obstacles.discs
        end = first + len(self._pillars)
        discs[first + self.fixed_pillars : end, :2] = self.others.discs[:, :2]
        self._shown.clear()

    def _lay_out(self) -> tuple[Array, NDArray[np.int64]]:
        """Return cylinders of all people, placed later, and of the pillars; and their owners."""
        people = PARTS * len(self.people_radius)
        fixed = people + len(self._pillars)
        discs = np.zeros((fixed + len(self.things), DISC_COLUMNS))
        discs[people:fixed, :3] = self._pillars
        discs[people:fixed, 3:] = self.pillar_heights
        owner = np.arange(people) // PARTS
        pillar = -(2 + len(self._walls) + np.arange(len(self._pillars)))
        owners = np.concatenate([owner, pillar, self.things[:, 0]]).astype(np.int64)
        return discs, owners

    def update(
        self,
        robot_state: RobotState | None,
        people_xyv: Array,
        present: NDArray[np.bool_],
        direction: Array | None = None,
        walked: Array | None = None,
        push: tuple[float, float, float] = _UNTOUCHED,
    ) -> None:
        """Update the scene to another instant.

        Args:
            robot_state: the robot's pose and motion.
            people_xyv: (M, 4) float64 x, y (m), vx, vy (m/s); kept as a view.
            present: (M,) bool, people in the world; kept as a view.
            direction: (M, 2) unit vectors of people's facing direction; default: unchanged.
            walked: (M,) distance walked, m, the phase of their legs; default: unchanged.
            push: force of people on the robot and its torque, N, N, N m.

        Raises:
            ValueError: a shape or type is wrong.
        """
        count = len(self.people_radius)
        if people_xyv.shape != (count, 4) or people_xyv.dtype != np.float64:
            raise ValueError(f"people must be float64 ({count}, 4), not {people_xyv.shape}")
        if present.shape != (count,) or present.dtype != np.bool_:
            raise ValueError(f"present must be bool ({count},), not {present.shape}")
        self.robot, self.push = robot_state, push
        self._people = people_xyv.view()
        self._people.setflags(write=False)
        self._present = present.view()
        self._present.setflags(write=False)
        self._direction = self._direction if direction is None else direction
        self._walked = self._walked if walked is None else walked
        self._placed = False
        self._shown.clear()

    @property
    def walls(self) -> Array:
        """Return segments (S, 4) x0, y0, x1, y1, m; those of other robots last."""
        return self._show("walls", lambda: immutable(self._walls))

    @property
    def pillars(self) -> Array:
        """Return circles (P, 3) x, y, radius, m; those of other robots last."""
        return self._show("pillars", lambda: immutable(self._pillars))

    @property
    def people(self) -> Array:
        """Return position x, y (m) and velocity x, y (m/s) of all people (M, 4), world frame."""
        return self._show("people", lambda: immutable(self._people))

    @property
    def present(self) -> NDArray[np.bool_]:
        """Return a mask of people in the world (M,)."""
        return self._show("present", lambda: immutable(self._present))

    def _show(self, name: str, copy: Callable[[], _Shown]) -> _Shown:
        """Return read-only data of this instant; copied once."""
        if name not in self._shown:
            self._shown[name] = copy()
        shown: _Shown = self._shown[name]
        return shown

    @property
    def people_hip(self) -> Array:
        """Return people's individual hip heights (M,), m; 0: default."""
        none = np.zeros(len(self.people_radius))
        return immutable(none if self._gait is None else self._gait[:, 0])

    @property
    def headings(self) -> Array:
        """Return people's facing direction (M,), world frame, rad."""
        yaw: Array = np.arctan2(self._direction[:, 1], self._direction[:, 0])
        return immutable(yaw)

    @property
    def walked(self) -> Array:
        """Return the distance that people have walked (M,), m."""
        return immutable(self._walked)

    @property
    def cylinders(self) -> Array:
        """Return legs and trunks of people, pillars, then people's objects: (D, 5).

        The order per person is left leg, right leg, trunk.

        Columns are x, y, radius, bottom and top, m; absent people are at infinity.
        """
        return self.obstacles.discs

    def move_robot(self, robot_state: RobotState | None) -> None:
        """Update the robot only, for sensors that do not see people; people stay unchanged."""
        self.robot = robot_state

    @property
    def obstacles(self) -> Obstacles:
        """Return everything that rays can hit."""
        walls, heights, discs, owner = self._everything
        return self._show(
            "obstacles",
            lambda: Obstacles(
                immutable(walls), immutable(heights), immutable(discs), immutable(owner)
            ),
        )

    def obstacles_near(self, x: float, y: float, reach: float) -> Obstacles:
        """Return a superset of everything that rays from a point can hit within a distance, m."""
        walls, (_, _, discs, owner) = self._near.near(x, y, reach), self.obstacles
        return Obstacles(walls.segments, walls.heights, discs, owner)

    @property
    def _everything(self) -> Obstacles:
        """Return all obstacles, in arrays that are reused; people are placed when asked for."""
        if not self._placed:
            self._place()
            self._placed = True
        return self._obstacles

    def _place(self) -> None:
        now = self._people, self._present, self._direction
        sizes, discs = (self.people_radius, self.people_height), self._obstacles.discs
        if self._gait is None:
            place_people(*now, self._walked, *sizes, discs)
            return
        place_looks(*now, self._walked, *sizes, self._gait, discs)
        place_things(*now, self.things, len(discs) - len(self.things), discs)

    def cast(
        self, origins: Array, directions: Array, max_range: float
    ) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return the nearest hit of each ray on a wall, a pillar or a person.

        Fast for consecutive rays with equal origins. An origin inside a body, or on its surface,
        hits it at distance 0 with incidence 0.

        Args:
            origins: (R, 3) world frame, m.
            directions: (R, 3) world frame; any length but zero.
            max_range: m; farther hits do not count.

        Returns:
            distance (R,) m, inf without a hit; incidence (R,) angle to the surface normal, rad, 0
            without a hit; body (R,) int64, a person's index, -(2 + index) for a wall, and from
            there on for a pillar, -1 for none.
        """
        everything = self._everything
        if not _have_one_origin(origins):
            return cast_rays(origins, directions, max_range, *everything)
        x, y, z = origins[0].tolist()
        same = bool((origins[:, 2] == z).all())
        walls = self._near.near(x, y, max_range, z if same else math.nan)
        found = cast_rays(
            origins, directions, max_range, walls.segments, walls.heights, *everything[2:]
        )
        in_scene(found[2], walls)
        return found

    def cast_tilted(
        self, at: tuple[float, float, float], turn: Array, rays: Array, max_range: float
    ) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return the nearest hit of each of many rays from one point; the floor z = 0 is hit too.

        Args:
            at: the point, world frame, m.
            turn: (3, 3) rotation from the sensor's frame to the world frame.
            rays: (N, 3) directions of length 1, sensor frame.
            max_range: m; farther hits do not count.

        Returns:
            distance, incidence and body (N,) as in `cast`; the body of the floor is -1.
        """
        distance, incidence = np.full(len(rays), np.inf), np.zeros(len(rays))
        body = np.full(len(rays), -1, dtype=np.int64)
        walls, discs, owner = self._near.near(at[0], at[1], max_range, at[2]), *self._everything[2:]
        cast_tilted_rays(
            *at, turn, np.ascontiguousarray(rays), max_range, walls.segments, walls.heights, discs,
            owner, distance, incidence, body,
        )  # fmt: skip
        in_scene(body, walls)
        return distance, incidence, body

    def cast_grid(
        self,
        grid: RayGrid,
        at: tuple[float, float, float],
        yaw: float,
        max_range: float,
        *,
        floor: bool = False,
        details: bool = True,
    ) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return the nearest hit of each ray of a grid from one point, much faster than ray by ray.

        Args:
            at: the point, world frame, m.
            yaw: direction of the grid's azimuth 0, world frame, rad.
            max_range: m; farther hits do not count.
            floor: True if the floor is hit; its body is -1.
            details: True to compute incidence and body, otherwise empty.

        Returns:
            distance, incidence, body as in `cast`, each (R, C).
        """
        distance = np.empty(grid.shape)
        incidence, body = _NO_ANGLES, _NOBODY
        if details:
            incidence, body = np.empty(grid.shape), np.empty(grid.shape, dtype=np.int64)
        if distance.size:
            x, y, z = at
            walls, discs, owner = self._near.near(x, y, max_range, z), *self._everything[2:]
            cast_columns(
                x, y, z, yaw, max_range, floor, *grid.arrays, walls.segments, walls.heights,
                discs, owner, walls.order, walls.bound, distance, incidence, body,
            )  # fmt: skip
            in_scene(body, walls)
        return distance, incidence, body

    def render_depth(
        self, renderer: DepthRenderer, at: tuple[float, float, float], yaw: float
    ) -> NDArray[np.float32]:
        """Return the depth image of a level camera, including the floor.

        Args:
            renderer: renderer of the camera.
            at: its position, world frame, m.
            yaw: its heading, world frame, rad.

        Returns:
            (H, W) depth along the axis, m: 0 if too near, inf if nothing is in range.
        """
        image = np.empty(renderer.shape, np.float32)
        self._render(renderer, image, at, yaw)
        return image

    def render_depth_mm(
        self, renderer: DepthRenderer, at: tuple[float, float, float], yaw: float
    ) -> NDArray[np.uint16]:
        """Return the depth image of a level camera in whole millimetres; 0 if nothing is in range.

        The camera's range must be below `crowdbot.core.sensing.depth_renderer.MOST_MILLIMETRES`.
        """
        image = np.empty(renderer.shape, np.uint16)
        self._render(renderer, image, at, yaw)
        return image

    def _render(
        self,
        renderer: DepthRenderer,
        image: NDArray[np.float32] | NDArray[np.uint16],
        at: tuple[float, float, float],
        yaw: float,
    ) -> None:
        discs = self._everything.discs
        walls = self._near.near(at[0], at[1], renderer.reach, at[2])
        renderer.render_depth(image, at, yaw, walls, discs)
