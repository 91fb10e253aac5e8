"""ROS occupancy grids: ``map.yaml`` with an image, read as nav2's map server does.

Format: https://docs.nav2.org/configuration/packages/configuring-map-server.html.
"""

from __future__ import annotations

import logging
import re
from dataclasses import dataclass
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, InputError, did_you_mean, nearest
from crowdbot.plugin.for_environments import SpecError, read_document
from crowdbot.plugins.environments.map_image_build import Alpha

_LOG = logging.getLogger(__name__)
#: Default thresholds, those of ROS, by which the grey 205 is unknown.
_OCCUPIED, _FREE = 0.65, 0.196
#: Grey of unknown cells in the images of ROS.
_COARSE = 0.9  # m; cells of maps for robots are smaller
_UNKNOWN = 205 / 255
#: How a path begins that a shell, a launch file or a client of ROS resolves.
_ELSEWHERE = re.compile(r"~|\$|[a-z]+://")
#: Interpretations of pixels, the default first, and what opacity means in each.
_OPACITY: dict[str, Alpha] = {"trinary": "averaged", "scale": "unknown", "raw": "ignored"}
_MODES = tuple(_OPACITY)


@dataclass(frozen=True, slots=True, kw_only=True)
class RosMap:
    """The contents of a ``map.yaml``.

    Attributes:
        image: image path as written in the file.
        resolution: side of a cell, m.
        origin: x, y (m) and yaw (rad) of the lower left corner of the image.
        negate: True if dark cells are free.
        occupied, free: probability above which a cell is occupied, below which it is free; in
            ``raw`` 0 per cent is free, too.
        mode: ``raw``: pixels are per cent, from 0 to 100; ``scale``: as ``trinary``, but
            transparent pixels are unknown; ``trinary``: opacity counts as one more colour.
    """

    image: str
    resolution: float
    origin: tuple[float, float, float]
    negate: bool
    occupied: float
    free: float
    mode: str = "trinary"

    @property
    def alpha(self) -> Alpha:
        """Return how the opacity of pixels is used: see `read_grey`."""
        return _OPACITY[self.mode]

    def image_beside(self, file: Path) -> Path:
        """Return the image's path from ``map.yaml``; of an absolute path, the name only."""
        return file.parent / relative_image(self.image)

    def at(self, points: Array) -> Array:
        """Return points (N, 2), in cells from the lower left corner, in the map's frame, m."""
        c, s = np.cos(self.origin[2]), np.sin(self.origin[2])
        turn = self.resolution * np.array([[c, -s], [s, c]])
        found: Array = points @ turn.T + self.origin[:2]
        return found

    def occupancy(self, grey: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the probability that each pixel (H, W), grey 0 to 1, is occupied; NaN: unknown."""
        if self.mode == "raw":
            share = np.round(255.0 * grey) / 100.0
            return np.where(share <= 1.0, share, np.nan)
        return grey if self.negate else 1.0 - grey


def tell_units(name: str, ros_map: RosMap) -> None:
    """Warn of a yaw that is hardly in radians, and of cells that are hardly in metres."""
    if abs(ros_map.origin[2]) > 2.0 * np.pi:
        _LOG.warning("%s: yaw is %g rad: degrees?", name, ros_map.origin[2])
    if ros_map.resolution > _COARSE:
        _LOG.warning("%s: resolution is %g m: centimetres?", name, ros_map.resolution)


def read_map(file: Path) -> RosMap:
    """Read a ``map.yaml``.

    Raises:
        InputError: it is not a valid map; the message says why.
    """
    try:
        content = read_document(file, file.name)
    except SpecError as error:
        raise InputError(f"{file.name}: is not a map.yaml: {error}") from error
    if not isinstance(content, dict) or "image" not in content:
        raise InputError(f"{file.name}: is not a map.yaml: it names no image")
    try:
        origin = tuple(_number("origin", v) for v in content["origin"])
        ros_map = RosMap(
            image=str(content["image"]),
            resolution=_number("resolution", content["resolution"]),
            origin=(origin[0], origin[1], origin[2] if len(origin) > 2 else 0.0),
            negate=bool(_number("negate", content.get("negate", 0))),
            occupied=_number("occupied_thresh", content.get("occupied_thresh", _OCCUPIED)),
            free=_number("free_thresh", content.get("free_thresh", _FREE)),
            mode=str(content.get("mode", _MODES[0])),
        )
    except KeyError as error:
        raise InputError(f"{file.name}: {error.args[0]} is missing") from error
    except (TypeError, ValueError, IndexError) as error:
        raise InputError(f"{file.name}: {error}") from error
    if len(origin) > 3:
        raise InputError(
            f"{file.name}: origin has {len(origin)} numbers; it is x, y (m) and yaw (rad)"
        )
    numbers = (ros_map.resolution, *ros_map.origin, ros_map.occupied, ros_map.free)
    if not (np.all(np.isfinite(numbers)) and ros_map.resolution > 0.0):
        raise InputError(f"{file.name}: resolution must be above 0, and all numbers finite")
    if not 0.0 <= ros_map.free <= ros_map.occupied <= 1.0:
        raise InputError(f"{file.name}: thresholds must be 0 <= free <= occupied <= 1")
    if ros_map.mode not in _MODES:
        known, near = ", ".join(_MODES), did_you_mean(nearest(ros_map.mode, _MODES))
        raise InputError(f"{file.name}: mode '{ros_map.mode}' is not one of {known}{near}")
    return ros_map


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {value!r} is not a number") from None


def image_of(file: Path) -> str | None:
    """Return the path of the image of a ``map.yaml`` from its folder, or None if it is not one."""
    try:
        return relative_image(read_map(file).image)
    except InputError:
        return None


def relative_image(image: str) -> str:
    """Return a path that stays valid if the map is copied to another machine.

    Absolute paths, which ROS 1 writes, are reduced to the file's name, and so are paths that only
    the other machine can resolve: ``~/``, ``$(find maps)/``, ``package://``.
    """
    if _ELSEWHERE.match(image):
        return PurePosixPath(image).name
    for path in (PurePosixPath(image), PureWindowsPath(image)):
        if path.is_absolute():
            return path.name
    return image


def _taken_for_free(ros_map: RosMap) -> bool:
    return bool(ros_map.occupancy(np.array([_UNKNOWN]))[0] < ros_map.free)


def free_cells(
    ros_map: RosMap, grey: NDArray[np.float64], *, unknown_is_free: bool
) -> NDArray[np.bool_]:
    """Return a mask of walkable cells (H, W)."""
    probability = ros_map.occupancy(grey)
    if ros_map.mode == "trinary" and np.any(grey == _UNKNOWN) and _taken_for_free(ros_map):
        _LOG.warning(
            "%s: %d cells are grey 205, which map savers write where nothing is known; with "
            "free_thresh %g they are free, as nav2 takes them; with 0.196 they are not",
            ros_map.image, np.count_nonzero(grey == _UNKNOWN), ros_map.free,
        )  # fmt: skip
    if unknown_is_free:
        return ~(probability > ros_map.occupied)
    known_free = (probability == 0.0) if ros_map.mode == "raw" else np.zeros(grey.shape, np.bool_)
    return np.asarray((probability < ros_map.free) | known_free)
