"""Show a running simulation in the browser, through Drake's Meshcat."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from pydrake.geometry import (
    Box,
    Cylinder,
    Meshcat,
    MeshcatParams,
    Rgba,
    SurfaceTriangle,
    TriangleSurfaceMesh,
)
from pydrake.math import RigidTransform, RollPitchYaw

from crowdbot.core.recording.drawings import drawn_lines
from crowdbot.core.recording.header import AgentsHeader, RecordingHeader, RobotHeader
from crowdbot.core.recording.text_lines import text_lines
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

_WALL_HEIGHT, _WALL_WIDTH, _PERSON_HEIGHT, _ROBOT_HEIGHT = 1.0, 0.05, 1.7, 0.5
_FLOOR, _LINE_HEIGHT = 0.01, 0.03
_THOUGHT = Rgba(0.7, 0.35, 0.0, 1.0)
_WALL, _PERSON = Rgba(0.45, 0.45, 0.47, 1.0), Rgba(0.36, 0.55, 0.78, 1.0)
_ROBOT, _NOSE, _GOAL = (
    Rgba(0.85, 0.45, 0.1, 1.0),
    Rgba(0.2, 0.2, 0.2, 1.0),
    Rgba(0.2, 0.7, 0.3, 0.5),
)
_RIM = 24


class MeshcatView:
    """Watches runs and shows walls, people, and the robots with their goals.

    Attributes:
        url: address for a browser.
    """

    def __init__(self, port: int = 0, host: str = "localhost") -> None:
        """Start serving.

        Raises:
            InputError: the port is not available.
        """
        try:
            self._meshcat = Meshcat(
                MeshcatParams(host=host, port=port or None, show_stats_plot=False)
            )
        except RuntimeError as error:
            raise InputError(f"--meshcat {port}: that port cannot be had") from error
        self.url = str(self._meshcat.web_url())
        self._shown: set[int] = set()
        self._robots: set[str] = set()

    def begin(self, shared: RecordingHeader, robots: Mapping[str, RecordingHeader]) -> None:
        """Show static objects, and remove those of an earlier run."""
        show = self._meshcat
        show.Delete("crowdbot")
        for k, row in enumerate(() if shared.walls is None else shared.walls.tolist()):
            _wall(show, f"crowdbot/walls/{k}", row)
        for name, header in robots.items():
            if header.goal_zone is not None and len(header.goal_zone):
                goal = _prism(header.goal_zone, 0.0, _FLOOR)
                show.SetObject(f"crowdbot/goals/{name}", goal, _GOAL)
            if header.robot is not None:
                _robot(show, f"crowdbot/robots/{name}", header.robot)
        self._robots = set(robots)
        if shared.agents is not None:
            _people(show, shared.agents)
            self._shown = set(range(len(shared.agents.id)))
        show.SetCameraPose(np.array([-4.0, 0.0, 9.0]), np.array([6.0, 0.0, 0.0]))

    def sample(self, t: float, robots: Mapping[str, Sequence[float]], agents: Array | None) -> None:
        """Move robots and people; those that are absent are hidden."""
        show = self._meshcat
        show.SetSimulationTime(t)
        for name in sorted(self._robots ^ set(robots)):
            show.SetProperty(f"crowdbot/robots/{name}", "visible", name in robots)
        self._robots = set(robots)
        for name, row in robots.items():
            show.SetTransform(f"crowdbot/robots/{name}", _placed(*row[:3]))
        if agents is not None:
            self._move_people(agents)

    def drawing(
        self,
        t: float,
        robot: str,
        name: str,
        columns: Array,
        texts: Sequence[str] | None = None,
    ) -> None:
        """Show what a planner drew last, as lines on the floor; Meshcat has no letters."""
        del t
        path = f"crowdbot/thoughts/{robot}/{name}"
        lines = drawn_lines(columns, name) if texts is None else text_lines(columns, texts)
        if not lines.shape[1]:
            self._meshcat.Delete(path)
            return
        start, end = (np.column_stack([part, np.full(len(part), _LINE_HEIGHT)]).T for part in lines)
        self._meshcat.SetLineSegments(path, start, end, 2.0, _THOUGHT)

    def _move_people(self, agents: Array) -> None:
        show = self._meshcat
        there = set(np.flatnonzero(np.isfinite(agents[0])).tolist())
        for k in sorted(self._shown ^ there):
            show.SetProperty(f"crowdbot/people/{k}", "visible", k in there)
        self._shown = there
        for k in sorted(there):
            x, y, vx, vy = agents[:, k].tolist()
            show.SetTransform(f"crowdbot/people/{k}", _placed(x, y, math.atan2(vy, vx)))

    def page(self) -> str:
        """Return the current scene as one HTML page without a server."""
        return str(self._meshcat.StaticHtml())


def _wall(show: Meshcat, path: str, ends: Sequence[float]) -> None:
    x0, y0, x1, y1 = ends
    length, angle = math.hypot(x1 - x0, y1 - y0), math.atan2(y1 - y0, x1 - x0)
    show.SetObject(path, Box(max(length, _WALL_WIDTH), _WALL_WIDTH, _WALL_HEIGHT), _WALL)
    middle = _placed(0.5 * (x0 + x1), 0.5 * (y0 + y1), angle, 0.5 * _WALL_HEIGHT)
    show.SetTransform(path, middle)


def _robot(show: Meshcat, path: str, robot: RobotHeader) -> None:
    angle = np.linspace(0.0, 2.0 * math.pi, _RIM, endpoint=False)
    circle = robot.radius * np.column_stack((np.cos(angle), np.sin(angle)))
    outline = circle if robot.footprint is None else robot.footprint
    show.SetObject(f"{path}/body", _prism(outline, 0.05, _ROBOT_HEIGHT), _ROBOT)
    front = float(np.max(outline[:, 0]))
    show.SetObject(f"{path}/front", Box(0.1, 0.08, 0.08), _NOSE)
    show.SetTransform(f"{path}/front", _placed(front, 0.0, 0.0, _ROBOT_HEIGHT))


def _people(show: Meshcat, people: AgentsHeader) -> None:
    for k, radius in enumerate(people.radius.tolist()):
        path = f"crowdbot/people/{k}"
        show.SetObject(f"{path}/body", Cylinder(radius, _PERSON_HEIGHT), _PERSON)
        show.SetTransform(f"{path}/body", _placed(0.0, 0.0, 0.0, 0.5 * _PERSON_HEIGHT))
        show.SetObject(f"{path}/face", Box(0.1, 0.06, 0.06), _NOSE)
        show.SetTransform(f"{path}/face", _placed(radius, 0.0, 0.0, _PERSON_HEIGHT - 0.1))


def _placed(x: float, y: float, yaw: float, z: float = 0.0) -> RigidTransform:
    return RigidTransform(RollPitchYaw(0.0, 0.0, yaw), [x, y, z])


def _prism(outline: Array, low: float, high: float) -> TriangleSurfaceMesh:
    """Return a prism over a convex outline (K, 2), counter-clockwise, between two heights, m."""
    count = len(outline)
    corners = [np.array([x, y, z]) for z in (low, high) for x, y in np.asarray(outline).tolist()]
    faces = []
    for k in range(count):
        after = (k + 1) % count
        faces += [(k, after, count + after), (k, count + after, count + k)]
        if 0 < k < count - 1:
            faces += [(0, after, k), (count, count + k, count + after)]
    return TriangleSurfaceMesh([SurfaceTriangle(*face) for face in faces], corners)
