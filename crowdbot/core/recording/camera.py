"""Messages of a camera: depth in millimetres, colour, and how the camera is made."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.interfaces import Pinhole, Reading, SensorInfo
from crowdbot.core.optical import optical
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording import template
from crowdbot.core.recording.template import Template

Kind = Literal["depth", "colour"]
_ENCODINGS: dict[Kind, str] = {"depth": "16UC1", "colour": "rgb8"}


class Photograph(NamedTuple):
    """What is kept of a camera's reading: its time (ns) and pixels, by what they show."""

    ns: int
    pixels: dict[Kind, NDArray[Any]]

    @property
    def size(self) -> int:
        """Bytes."""
        return sum(pixels.nbytes for pixels in self.pixels.values())


class ImageMessage(NamedTuple):
    """One serialised message, in pieces that are good until the next message is asked for."""

    topic: str
    msgtype: str
    pieces: list[bytes | memoryview]


class CameraMessages:
    """What readings of one camera become: depth, colour if there is some, a CameraInfo each."""

    def __init__(self, name: str, info: SensorInfo) -> None:
        """Prepare.

        Args:
            name: of the sensor: the root of its topics.
            info: of a sensor with a ``camera``.
        """
        assert info.camera is not None
        # Here, for numba is not to be loaded by those who only read.
        from crowdbot.core.recording.millimetres import millimetres

        self._millimetres = millimetres
        self._root = f"/{name}"
        head = ros.header(template.ANY_TIME, optical(info.frame))
        self._about = Template(_camera_info(head, info.camera), template.ANY_STAMP)
        self._blank = cache(lambda encoding, size: _image(head, encoding, (*info.shape, size)))
        self._pixels = math.prod(info.shape)

    def keep(self, reading: Reading) -> Photograph:
        """A copy of what is to be written of a reading.

        Args:
            reading: depth in m; 0 and inf, for too near and too far, both become 0, which is ROS'
                word for no measurement in ``16UC1``.
        """
        depth = self._millimetres(reading.values.astype(np.float32, copy=False))
        pixels: dict[Kind, NDArray[Any]] = {"depth": depth}
        if reading.colour is not None:
            pixels["colour"] = reading.colour.copy()
        return Photograph(ros.nanoseconds(reading.stamp), pixels)

    def messages(self, photograph: Photograph) -> Iterator[ImageMessage]:
        """An image and a CameraInfo each."""
        stamp = template.stamp(photograph.ns)
        for kind, pixels in photograph.pixels.items():
            image = self._blank(_ENCODINGS[kind], pixels.nbytes // self._pixels)
            for leaf, form, parts in (
                ("image_raw", image, (stamp, pixels.data.cast("B"))),
                ("camera_info", self._about, (stamp,)),
            ):
                topic = f"{self._root}/{kind}/{leaf}"
                yield ImageMessage(topic, form.msgtype, form.pieces(*parts))


def _image(head: Any, encoding: str, shape: tuple[int, int, int]) -> Template:
    """Places: stamp; bytes of the pixels, rows by columns by bytes."""
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


def _camera_info(head: Any, camera: Pinhole) -> Any:
    f, (cx, cy) = camera.focal, camera.centre
    return ros.new(
        "sensor_msgs/CameraInfo",
        header=head,
        height=camera.height,
        width=camera.width,
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
