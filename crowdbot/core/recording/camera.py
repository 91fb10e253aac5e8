"""Messages of a camera: depth in millimetres, colour, and camera info."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.messages as ros
import crowdbot.core.recording.template as template
from crowdbot.core.geometry.optical_frame import optical
from crowdbot.core.recording.reading.images import Grid, grid_of, thinned
from crowdbot.core.recording.template import Template
from crowdbot.core.types.sensor import CameraFrame, Pinhole, SensorInfo


class ImageMessage(NamedTuple):
    """One serialised message, in pieces that are valid until the next message is requested."""

    topic: str
    msgtype: str
    pieces: list[bytes | memoryview]


class CameraMessages:
    """The messages of one camera's images: depth, colour if available, with a CameraInfo each."""

    def __init__(self, name: str, info: SensorInfo, width: int | None = None) -> None:
        """Prepare the messages.

        Args:
            name: name of the sensor, root of its topics.
            info: info of a sensor with a ``camera``.
            width: drop rows and columns so that at most this many columns remain.
        """
        assert info.camera is not None
        self._width = width = width or info.camera.width
        self._root = f"/{name}"
        head = ros.header(template.ANY_TIME, optical(info.frame))
        rows, columns = thinned(np.zeros(info.shape, np.bool_), width).shape
        about = _camera_info(head, info.camera, (rows, columns), grid_of(info.shape, width))
        self._about = Template(about, template.ANY_STAMP)
        self._blank = cache(lambda encoding, size: _image(head, encoding, (rows, columns, size)))
        self._pixels = rows * columns

    def __call__(self, frame: CameraFrame) -> Iterator[ImageMessage]:
        """Yield the messages of one image."""
        stamp = template.stamp(ros.nanoseconds(frame.stamp))
        yield from self._pair("depth", "16UC1", stamp, thinned(frame.depth_mm, self._width))
        if frame.colour is not None:
            yield from self._pair("color", "rgb8", stamp, thinned(frame.colour, self._width))

    def _pair(
        self, kind: str, encoding: str, stamp: bytes, pixels: NDArray[Any]
    ) -> Iterator[ImageMessage]:
        blank = self._blank(encoding, pixels.nbytes // self._pixels)
        for leaf, form, parts in (
            ("image_raw", blank, (stamp, np.ascontiguousarray(pixels).data.cast("B"))),
            ("camera_info", self._about, (stamp,)),
        ):
            topic = f"{self._root}/{kind}/{leaf}"
            yield ImageMessage(topic, form.msgtype, form.pieces(*parts))


def _image(head: Any, encoding: str, shape: tuple[int, int, int]) -> Template:
    """Return a template. Places: stamp; bytes of the pixels, rows by columns by bytes."""
    rows, columns, depth = shape
    data = np.full(rows * columns * depth, 0x5A, np.uint8)
    message = ros.new(
        "sensor_msgs/Image",
        header=head,
        height=rows,
        width=columns,
        encoding=encoding,
        is_bigendian=0,
        step=columns * depth,
        data=data,
    )
    return Template(message, template.ANY_STAMP, data.tobytes())


def _camera_info(head: Any, camera: Pinhole, size: tuple[int, int], grid: Grid) -> Any:
    """Return the CameraInfo of images (rows, columns) with the pixels of a grid."""
    f, (column, row) = camera.focal / grid.every, camera.centre
    cx, cy = (column - grid.column) / grid.every, (row - grid.row) / grid.every
    return ros.new(
        "sensor_msgs/CameraInfo",
        header=head,
        height=size[0],
        width=size[1],
        distortion_model="plumb_bob",
        d=np.zeros(5),
        k=np.array([f, 0, cx, 0, f, cy, 0, 0, 1.0]),
        r=np.eye(3).ravel(),
        p=np.array([f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1.0, 0]),
        binning_x=0,
        binning_y=0,
        roi=ros.new(
            "sensor_msgs/RegionOfInterest",
            x_offset=0, y_offset=0, height=0, width=0, do_rectify=False,
        ),
    )  # fmt: skip
