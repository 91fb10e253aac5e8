"""Addresses of a lidar's arrays, for compiled code."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable, ScratchPool
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.sensing.appearance_model import gaits
from crowdbot.core.sensing.body_model import PARTS
from crowdbot.core.sensing.mount import mount_pose, mount_tilt
from crowdbot.core.sensing.other_robots import OtherRobot
from crowdbot.core.sensing.ray_grid import RayGrid
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.support.records import record_type, rows_of
from crowdbot.core.types.robot import RobotModel
from crowdbot.core.types.sensor import SensorInfo

#: Arrays of a scanner, in the order of the columns below.
SCANNER_FIELDS = (
    "own", "noise", "azimuth", "cos", "sin", "slope", "slope_scale", "work", "filled", "directions",
    "runs", "walls", "wall_heights", "discs", "owner", "order", "bound", "people", "direction",
    "walked", "present", "radius", "height", "gait", "things", "others", "sides", "ranges",
    "incidence", "body",
)  # fmt: skip
(
    OWN, NOISE, AZIMUTH, COS, SIN, SLOPE, SLOPE_SCALE, WORK, FILLED, DIRECTIONS,
    RUNS, WALLS, WALL_HEIGHTS, DISCS, OWNER, ORDER, BOUND, PEOPLE, DIRECTION,
    WALKED, PRESENT, RADIUS, HEIGHT, GAIT, THINGS, OTHERS, SIDES, RANGES,
    INCIDENCE, BODY,
) = range(len(SCANNER_FIELDS))  # fmt: skip

#: Kinds of lidars that are cast in compiled code.
COMPILED_KINDS = ("lidar2d", "lidar3d")
#: Kinds of noise that are drawn in compiled code, with the fields of their specs.
NOISE_KINDS = {
    "gaussian": ("mean", "std"),
    "offset": ("value",),
    "peak": ("mean", "std", "probability"),
}
GAUSSIAN, OFFSET, PEAK = range(len(NOISE_KINDS))
#: Columns of the table of other robots: row in the crowd's table, of its disc (-1: none), of its
#: first plate, and number of plates.
O_ROBOT, O_DISC, O_PLATE, O_PLATES = range(4)


@dataclass(frozen=True, slots=True, kw_only=True)
class SeenSensor:
    """A robot's sensor: name, the robot's index, description, and the run's sensor object."""

    name: str
    robot: int
    spec: Any
    info: SensorInfo
    sensor: Any

    @property
    def compiled(self) -> bool:
        """True for level lidars without errors whose noise, if any, is built in."""
        spec = self.spec
        return bool(
            spec.kind in COMPILED_KINDS
            and mount_tilt(spec.mount) == (0.0, 0.0)
            and not spec.errors
            and all(noise.kind in NOISE_KINDS for noise in spec.noise.values())
        )


class ScannerRecord:
    """Mount, range and digits of one lidar, as a record for compiled code.

    Attributes:
        x, y, z, yaw: its place on the base, z over the floor, m and rad.
        least, most: range, m; ``step`` is that of its digits, 0 for none.
        dropout: probability that a beam is lost.
        most_incidence: angle to the normal beyond which a surface is not seen, rad.
        rate: Hz; 0 for a sensor that is read outside of compiled code.
        floor: 1 if it sees the floor.
        robot: row of its robot in the crowd's table.
        new: 1 if it was read since the step began.
    """

    x: float
    y: float
    z: float
    yaw: float
    least: float
    most: float
    step: float
    dropout: float
    most_incidence: float
    rate: float
    floor: float
    robot: float
    new: float


SCANNER = record_type(ScannerRecord)


def scanner_table(
    seen: SeenSensor, models: Sequence[RobotModel], scene: Scene, pool: ScratchPool
) -> ArrayTable:
    """Return a table with the addresses of a lidar's arrays; see `SeenSensor.compiled`.

    Args:
        seen: the lidar.
        models: of all robots.
        scene: people and place, with the other robots.
        pool: scratch.
    """
    spec, robot = seen.spec, seen.robot
    own, grid = ArrayTable(SCANNER_FIELDS), _grid(seen.info)
    own.put(own=_record(seen, models[robot]), noise=_noise(spec))
    fan = grid.arrays._asdict()
    pool.put(own, **{name: fan.pop(name) for name in ("work", "filled", "directions", "runs")})
    own.put(**fan)
    _put_scene(own, scene, pool)
    _put_others(own, scene, robot, len(models))
    slanted = grid.shape if spec.max_incidence < math.pi / 2 else (0, 0)
    own.put(
        ranges=np.full(grid.shape, np.inf),
        incidence=np.zeros(slanted),
        body=np.zeros((0, 0), np.int64),
    )
    return own


def _grid(info: SensorInfo) -> RayGrid:
    """Return the rays of a lidar of one layer or of several."""
    angles = info.angles
    assert angles is not None
    if angles.ndim == 1:
        return RayGrid(angles, [0.0])
    return RayGrid(angles[0, :, 0], np.tan(angles[:, 0, 1]))


def _record(seen: SeenSensor, model: RobotModel) -> Any:
    spec, info = seen.spec, seen.info
    x, y, z, yaw = mount_pose(spec.mount)
    row = rows_of(1, SCANNER)
    step = (spec.range_max - spec.range_min) / 2.0**spec.bits if spec.bits else 0.0
    for field, value in {
        "x": x, "y": y, "z": model.base_height + z, "yaw": yaw, "least": spec.range_min,
        "most": spec.range_max, "step": step, "dropout": spec.dropout,
        "most_incidence": spec.max_incidence, "rate": info.rate,
        "floor": float(info.category == "lidar3d"), "robot": float(seen.robot),
    }.items():  # fmt: skip
        row[field][:] = value
    return row


def _noise(spec: Any) -> Any:
    """Return the table (K, 4) of a sensor's noise models: kind, and the fields of its spec."""
    rows = []
    for noise in spec.noise.values():
        values = [float(getattr(noise, field)) for field in NOISE_KINDS[noise.kind]]
        rows.append([list(NOISE_KINDS).index(noise.kind), *values, *[0.0] * (3 - len(values))])
    return np.array(rows, np.float64).reshape(-1, 4)


def _put_scene(own: ArrayTable, scene: Scene, pool: ScratchPool) -> None:
    seen, count = scene.obstacles, len(scene.people_radius)
    gait = np.zeros((0, 5)) if scene.looks is None else gaits(scene.looks, scene.people_height)
    own.put(
        walls=np.array(seen.walls), wall_heights=np.array(seen.wall_heights),
        discs=np.array(seen.discs), owner=np.array(seen.owner),
        order=np.arange(len(seen.walls)), bound=np.zeros(len(seen.walls)),
        radius=np.array(scene.people_radius),
        height=np.array(scene.people_height), gait=np.array(gait), things=np.array(scene.things),
    )  # fmt: skip
    pool.put(
        own, people=np.zeros((count, 4)), direction=np.zeros((count, 2)), walked=np.zeros(count),
        present=np.zeros(count, np.bool_),
    )  # fmt: skip


def _put_others(own: ArrayTable, scene: Scene, robot: int, robots: int) -> None:
    """Write the other robots' surfaces: their rows in the scene, and their local outlines."""
    rows, sides = [], [np.zeros((0, 2))]
    plate, disc = scene.fixed_walls, PARTS * len(scene.people_radius) + scene.fixed_pillars
    others = [k for k in range(robots) if k != robot]
    for number, other in zip(others, scene.others.robots, strict=True):
        outline = other.footprint.outline(0.0, 0.0, 0.0) if len(other.footprint.corners) else ()
        rows.append([number, -1 if len(outline) else disc, plate, len(outline)])
        disc, plate = disc + (len(outline) == 0), plate + len(outline)
        sides.append(np.reshape(outline, (-1, 2)))
    own.put(
        others=np.array(rows, np.int64).reshape(-1, 4),
        sides=np.ascontiguousarray(np.concatenate(sides)),
    )


def others_of(models: Sequence[RobotModel], robot: int) -> list[OtherRobot]:
    """Return the indices of the robots that one robot's lidar can hit, in order."""
    return [
        OtherRobot(footprint_of_model(model), model.height)
        for number, model in enumerate(models)
        if number != robot
    ]
