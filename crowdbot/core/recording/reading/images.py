"""Read images from a recording, reduced in number and size for the replay page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.container.records import Record, decode
from crowdbot.core.recording.reading.scans import Thinning
from crowdbot.errors import InputError

#: Largest rate of images on the replay page, Hz, and largest width, pixels.
REPLAY_IMAGE_RATE, REPLAY_IMAGE_WIDTH = 2.0, 96

_LEAVES: dict[str, tuple[Literal["depth", "colour"], str]] = {
    "/depth/image_raw": ("depth", "16UC1"),
    "/color/image_raw": ("colour", "rgb8"),
    "/colour/image_raw": ("colour", "rgb8"),  # in older recordings
}


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayImages:
    """Images of one camera, all of one size.

    Attributes:
        kind: ``depth``: pixels are (K, H, W) uint16, mm, 0 if nothing was measured; ``colour``: (K,
            H, W, 3) uint8.
        t: (K,) stamps, increasing, s.
    """

    sensor: str
    kind: Literal["depth", "colour"]
    t: NDArray[np.float64]
    pixels: NDArray[Any]


class Grid(NamedTuple):
    """Pixels to keep: every n-th in both directions, starting at row and column."""

    every: int
    row: int
    column: int


def grid_of(shape: tuple[int, ...], width: int) -> Grid:
    """Return the pixels to keep of an image (H, W, ...), at most ``width`` columns."""
    rows, columns = shape[:2]
    every = -(-columns // width)
    return Grid(every, min(every // 2, rows - 1), every // 2)


def thinned(pixels: NDArray[Any], width: int) -> NDArray[Any]:
    """Return a view of an image (H, W, ...) without some rows and columns."""
    every, row, column = grid_of(pixels.shape, width)
    return pixels[row::every, column::every]


class ImageCollector:
    """Collects images from a recording's records, which are read by `Recording`.

    Args:
        path: the recording.
        max_rate: largest rate of kept images, Hz.
        width: largest width of kept images, pixels.
    """

    def __init__(self, path: Path, max_rate: float, width: int) -> None:
        self._path, self._max_rate, self._width = path, max_rate, width
        self._found: dict[str, list[tuple[int, NDArray[Any]]]] = {}
        self._thinning: dict[str, Thinning] = {}

    def add(self, record: Record) -> None:
        """Keep a record if it is an image for the page.

        Raises:
            InputError: it is damaged.
        """
        if record.msgtype != "sensor_msgs/msg/Image" or _leaf(record.topic) is None:
            return
        thinning = self._thinning.setdefault(record.topic, Thinning(self._max_rate))
        if thinning.keeps(record.ns):
            pixels = _pixels(self._path, record, self._width)
            self._found.setdefault(record.topic, []).append((record.ns, pixels))

    def images(self) -> list[ReplayImages]:
        """Return the images of all cameras so far.

        Raises:
            InputError: those of one differ in size.
        """
        return [_images(self._path, topic, rows) for topic, rows in self._found.items()]


def _leaf(topic: str) -> str | None:
    return next((leaf for leaf in _LEAVES if topic.endswith(leaf)), None)


def _pixels(path: Path, record: Record, width: int) -> NDArray[Any]:
    message = decode(path, record)
    kind, encoding = _LEAVES[_leaf(record.topic) or ""]
    depth = kind == "depth"
    shape = (message.height, message.width, *(() if depth else (3,)))
    flat = np.asarray(message.data, np.uint8).view("<u2") if depth else np.asarray(message.data)
    if message.encoding != encoding or flat.size != np.prod(shape) or not flat.size:
        raise InputError(
            f"{path}: {record.topic} holds an image of {message.encoding or 'no encoding'} with "
            f"{flat.size} numbers, not {encoding} of {message.width} x {message.height}"
        )
    return thinned(flat.reshape(shape), width).copy()


def _images(path: Path, topic: str, rows: list[tuple[int, NDArray[Any]]]) -> ReplayImages:
    leaf = _leaf(topic) or ""
    if len({pixels.shape for _, pixels in rows}) > 1:
        raise InputError(f"{path}: the images of {topic} differ in size")
    return ReplayImages(
        sensor=topic.removesuffix(leaf).removeprefix("/"),
        kind=_LEAVES[leaf][0],
        t=np.array([ns for ns, _ in rows]) / 1e9,
        pixels=np.stack([pixels for _, pixels in rows]),
    )
