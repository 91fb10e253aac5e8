"""Colour images, drawn by VTK through EGL: floor, walls, pillars, low-poly people, robots.

The images use a separate SceneGraph, so they do not slow the plant. VTK's images may differ between
machines: colour is not deterministic.
"""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from pydrake.common import MemoryFile
from pydrake.geometry import (
    Box,
    ClippingRange,
    ColorRenderCamera,
    Convex,
    Cylinder,
    FrameId,
    FramePoseVector,
    GeometryFrame,
    GeometryInstance,
    InMemoryMesh,
    LightParameter,
    MakeRenderEngineVtk,
    Mesh,
    PerceptionProperties,
    RenderCameraCore,
    RenderEngineVtkParams,
    Rgba,
    SceneGraph,
    Shape,
)
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.systems.sensors import CameraInfo

from crowdbot.core.figures.figure import Figure
from crowdbot.core.geometry.optical_frame import OPTICAL_RPY
from crowdbot.core.robots.look import visual_parts
from crowdbot.core.sensing.body_model import PARTS, TRUNK
from crowdbot.core.sensing.mount import sensor_pose_in_world
from crowdbot.core.sensing.other_robots import OtherRobot
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim.cameras.figure_pool import HIDDEN as _HIDDEN
from crowdbot.core.sim.cameras.figure_pool import FigurePool
from crowdbot.core.sim.cameras.person_mesh import leg_obj, trunk_obj
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.sensor import Pinhole
from crowdbot.dsl.spec.component_specs import SceneLight
from crowdbot.dsl.spec.spec import Mount
from crowdbot.errors import MissingLibraryError

_NAME = "vtk"
_FLOOR, _WALL, _PILLAR = (0.55, 0.53, 0.5), (0.8, 0.79, 0.75), (0.6, 0.6, 0.65)
_SKY = np.array([0.75, 0.85, 0.95])
_CLOTHES = (
    (0.75, 0.25, 0.2), (0.2, 0.35, 0.65), (0.25, 0.5, 0.3), (0.85, 0.7, 0.3),
    (0.45, 0.3, 0.5), (0.3, 0.3, 0.32), (0.85, 0.82, 0.78), (0.3, 0.6, 0.65),
)  # fmt: skip
#: Wheelchairs, strollers, suitcases.
_THING = (0.30, 0.30, 0.34)
_TROUSERS = ((0.16, 0.18, 0.26), (0.25, 0.22, 0.2), (0.22, 0.28, 0.36))
_ROBOT = (0.35, 0.38, 0.45)
_PROBE = "from crowdbot.core.sim.cameras.rendering import probe; probe()"


class Renderer:
    """Draws the colour images of one camera."""

    def __init__(
        self,
        scene: Scene,
        camera: Pinhole,
        mount: tuple[float, float, float, float],
        tilt: tuple[float, float] = (0.0, 0.0),
        robots: Sequence[RobotModel] = (),
        light: SceneLight | None = None,
        figures: Sequence[Figure] = (),
    ) -> None:
        """Build the scene for VTK.

        Args:
            scene: walls, pillars and sizes of people; these do not change.
            mount: x, y, z, yaw from base_link, m and rad.
            tilt: roll and pitch of the mount, rad.
            robots: appearance of the other robots in the scene.
            light: of the scene; None: a bright day.
            figures: meshes of people near the robot; without any they have the plain body.

        Raises:
            MissingLibraryError: this machine cannot draw.
        """
        check_egl()
        x, y, z, yaw = mount
        self._mount = Mount(x=x, y=y, z=z, yaw=yaw)
        self._tilt = tilt
        self._graph = SceneGraph()
        self._graph.AddRenderer(_NAME, MakeRenderEngineVtk(_parameters(light)))
        self._source = self._graph.RegisterSource("crowdbot")
        self._scenery(scene)
        self._people = self._crowd(scene)
        usual = float(np.median(scene.people_height)) if len(scene.people_height) else 1.7
        self._figures = FigurePool(self._graph, self._source, figures, usual)
        self._robots = self._fleet(scene, robots)
        self._context = self._graph.CreateDefaultContext()
        self._camera = _render_camera(camera)

    def __call__(self, scene: Scene, pose: Pose) -> NDArray[np.uint8]:
        """Return the image (H, W, 3), first row on top."""
        poses = FramePoseVector()
        meshes, drawn = self._figures.poses(scene, pose)
        for frame, place in zip(self._figures.frames, meshes, strict=True):
            poses.set_value(frame, place)
        bodies = _places(scene)
        for k in drawn:
            bodies[PARTS * k : PARTS * (k + 1)] = [_HIDDEN] * PARTS
        for frame, place in zip(self._people, bodies, strict=True):
            poses.set_value(frame, place)
        for frame, there in zip(self._robots, scene.others.poses, strict=True):
            poses.set_value(frame, _HIDDEN if there is None else _on_the_floor(there))
        self._graph.get_source_pose_port(self._source).FixValue(self._context, poses)
        at, yaw = sensor_pose_in_world(self._mount, scene, pose)
        eye = RigidTransform(
            _turned(*self._tilt, yaw) @ RollPitchYaw(*OPTICAL_RPY).ToRotationMatrix(),
            list(at),
        )
        query = self._graph.get_query_output_port().Eval(self._context)
        picture = query.RenderColorImage(self._camera, self._graph.world_frame_id(), eye)
        colours: NDArray[np.uint8] = picture.data[:, :, :3].copy()
        return colours

    def close(self) -> None:
        """Free graphics and meshes, in the thread that drew; nothing is drawn afterwards."""
        del self._context, self._graph

    def _scenery(self, scene: Scene) -> None:
        self._add(Box(400.0, 400.0, 0.1), RigidTransform([0.0, 0.0, -0.05]), _FLOOR, "floor")
        walls = zip(scene.walls, scene.wall_heights, strict=True)
        for k, (wall, (low, high)) in enumerate(islice(walls, scene.fixed_walls)):
            way, middle = wall[2:] - wall[:2], 0.5 * (wall[:2] + wall[2:])
            pose = RigidTransform(
                RotationMatrix.MakeZRotation(np.arctan2(way[1], way[0])),
                [*middle, 0.5 * (low + high)],
            )
            shape = Box(max(float(np.hypot(*way)), 1e-3), 0.01, high - low)
            self._add(shape, pose, _WALL, f"wall{k}")
        rounds = zip(scene.pillars, scene.pillar_heights, strict=True)
        for k, ((x, y, radius), (low, high)) in enumerate(islice(rounds, scene.fixed_pillars)):
            pose = RigidTransform([x, y, 0.5 * (low + high)])
            self._add(Cylinder(radius, high - low), pose, _PILLAR, f"pillar{k}")

    def _fleet(self, scene: Scene, models: Sequence[RobotModel]) -> list[FrameId]:
        """Return frames of the other robots: their visible shapes, else their outline's body."""
        frames = []
        for k, robot in enumerate(scene.others.robots):
            frame = self._graph.RegisterFrame(self._source, GeometryFrame(f"robot{k}"))
            frames.append(frame)
            solids = visual_parts(models[k]) if k < len(models) else []
            for part, (corners, colour) in enumerate(solids):
                shape = Convex(points=corners.T, label=f"robot{k}_{part}")
                lift = RigidTransform([0.0, 0.0, models[k].base_height])
                self._add(shape, lift, _rgb(colour), f"robot{k}_{part}", frame)
            if not solids:
                self._upright(robot, f"robot{k}", frame)
        return frames

    def _upright(self, robot: OtherRobot, name: str, frame: FrameId) -> None:
        """Add a robot of which only outline and height are known."""
        outline, lift = robot.footprint.outline(0.0, 0.0, 0.0), 0.0
        shape: Shape
        if len(outline):
            corners = [(x, y, z) for x, y in outline for z in (0.0, robot.height)]
            shape = Convex(points=np.array(corners).T, label=name)
        else:
            shape, lift = Cylinder(robot.footprint.radius, robot.height), 0.5 * robot.height
        self._add(shape, RigidTransform([0.0, 0.0, lift]), _ROBOT, name, frame)

    def _crowd(self, scene: Scene) -> list[FrameId]:
        """Return frames of everyone's legs and trunk, then of their objects.

        Equal sizes share meshes.
        """
        frames, meshes = [], dict[tuple[float, float, float], tuple[Mesh, ...]]()
        sizes = zip(
            scene.people_height.tolist(), scene.people_radius.tolist(), scene.people_hip.tolist(),
            strict=True,
        )  # fmt: skip
        for k, size in enumerate(sizes):
            if size not in meshes:
                leg = _mesh(leg_obj(*size))
                meshes[size] = leg, leg, _mesh(trunk_obj(*size))
            colours = _TROUSERS[k % len(_TROUSERS)], _CLOTHES[k % len(_CLOTHES)]
            for part, mesh in enumerate(meshes[size]):
                name = f"person{k}_{part}"
                frame = self._graph.RegisterFrame(self._source, GeometryFrame(name))
                self._add(mesh, RigidTransform(), colours[part == TRUNK], name, frame)
                frames.append(frame)
        for k, (*_, radius, low, high) in enumerate(scene.things.tolist()):
            frame = self._graph.RegisterFrame(self._source, GeometryFrame(f"thing{k}"))
            pose = RigidTransform([0.0, 0.0, 0.5 * (low + high)])
            self._add(Cylinder(radius, high - low), pose, _THING, f"thing{k}", frame)
            frames.append(frame)
        return frames

    def _add(
        self,
        shape: Shape,
        pose: RigidTransform,
        colour: tuple[float, float, float],
        name: str,
        frame: FrameId | None = None,
    ) -> None:
        instance = GeometryInstance(pose, shape, name)
        looks = PerceptionProperties()
        looks.AddProperty("phong", "diffuse", Rgba(*colour, 1.0))
        instance.set_perception_properties(looks)
        where = self._graph.world_frame_id() if frame is None else frame
        self._graph.RegisterGeometry(self._source, where, instance)


def _turned(roll: float, pitch: float, yaw: float) -> RotationMatrix:
    if roll == 0.0 and pitch == 0.0:
        return RotationMatrix.MakeZRotation(yaw)
    return RollPitchYaw(roll, pitch, yaw).ToRotationMatrix()


def _rgb(colour: str) -> tuple[float, float, float]:
    """Return ``#rrggbb`` as numbers from 0 to 1."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return red, green, blue


def _on_the_floor(pose: Pose) -> RigidTransform:
    return RigidTransform(RotationMatrix.MakeZRotation(pose.yaw), [pose.x, pose.y, 0.0])


def _mesh(text: str) -> Mesh:
    return Mesh(InMemoryMesh(mesh_file=MemoryFile(text.encode(), ".obj", "person")))


def _parameters(light: SceneLight | None = None) -> RenderEngineVtkParams:
    if light is not None:
        return _lit(light)
    sun = LightParameter(
        type="directional", frame="world", direction=[0.4, 0.6, -1.0], intensity=0.8
    )
    lamp = LightParameter(
        type="directional", frame="camera", direction=[0.0, 0.3, 1.0], intensity=0.5
    )
    # Walls that neither light reaches would be black.
    sky = LightParameter(
        type="directional", frame="world", direction=[-0.5, -0.7, -0.3], intensity=0.35
    )
    return RenderEngineVtkParams(lights=[sun, lamp, sky], default_clear_color=_SKY, backend="EGL")


def _lit(light: SceneLight) -> RenderEngineVtkParams:
    """Return lights of a scene's strengths and colours, with its sun, and the sky on all sides."""
    sun = LightParameter(
        type="directional", frame="world", direction=[-x for x in light.towards_sun],
        intensity=0.8 * light.sun, color=Rgba(*_rgb(light.colour), 1.0),
    )  # fmt: skip
    lamp = LightParameter(
        type="directional", frame="camera", direction=[0.0, 0.3, 1.0], intensity=0.5 * light.ambient
    )
    sides = [(0.5, 0.7), (-0.5, -0.7), (0.7, -0.5), (-0.7, 0.5)]
    sky = [
        LightParameter(
            type="directional", frame="world", direction=[x, y, -0.1],
            intensity=0.3 * light.ambient,
        )
        for x, y in sides
    ]  # fmt: skip
    return RenderEngineVtkParams(
        lights=[sun, lamp, *sky], default_clear_color=np.array(_rgb(light.sky)), backend="EGL"
    )


def _render_camera(camera: Pinhole) -> ColorRenderCamera:
    focal, (cx, cy) = camera.focal, camera.centre
    # Drake measures from the corner of the first pixel, ROS from its centre.
    about = CameraInfo(camera.width, camera.height, focal, focal, cx + 0.5, cy + 0.5)
    core = RenderCameraCore(_NAME, about, ClippingRange(0.01, 200.0), RigidTransform())
    return ColorRenderCamera(core, False)


def _places(scene: Scene) -> list[RigidTransform]:
    """Return poses of legs and trunks, person by person; absent people are below the floor."""
    turns = [RotationMatrix.MakeZRotation(yaw) for yaw in scene.headings.tolist()]
    centres = scene.cylinders[: PARTS * len(turns), :2].reshape(-1, PARTS, 2).tolist()
    bodies = [
        RigidTransform(turn, [x, y, 0.0]) if here else _HIDDEN
        for parts, turn, here in zip(centres, turns, scene.present, strict=True)
        for x, y in parts
    ]
    things = scene.cylinders[len(scene.cylinders) - len(scene.things) :, :2].tolist()
    return bodies + [
        RigidTransform([x, y, 0.0]) if math.isfinite(x) else _HIDDEN for x, y in things
    ]


# ------------------------------------------------------------------------------- EGL
@cache
def check_egl() -> None:
    """Check in another process if images can be drawn, since a failure kills the process.

    Raises:
        MissingLibraryError: they cannot; the message names packages to install.
    """
    done = subprocess.run(
        [sys.executable, "-c", _PROBE], capture_output=True, text=True, timeout=60, check=False
    )
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or [f"it ended with {done.returncode}"])[-1]
        raise MissingLibraryError(
            "colour images need EGL and OpenGL, which do not work here; install them with "
            f"'apt-get install libegl1 libgl1', or set colour: false ({last})"
        )


def probe() -> None:
    """Draw one small image; may crash if libraries are missing."""
    graph = SceneGraph()
    graph.AddRenderer(_NAME, MakeRenderEngineVtk(_parameters()))
    query = graph.get_query_output_port().Eval(graph.CreateDefaultContext())
    camera = _render_camera(Pinhole(width=8, height=8, focal=8.0))
    query.RenderColorImage(camera, graph.world_frame_id(), RigidTransform())
