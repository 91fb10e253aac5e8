"""Messages of a camera: depth in millimetres, colour, and how the camera is made."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from crowdbot.core.interfaces import Array, Pinhole, Reading, SensorInfo
from crowdbot.core.optical import optical
from crowdbot.core.recording import messages as ros

_FARTHEST = 65.535  # m, in millimetres of 16 bits


class ImageMessage(NamedTuple):
    """One serialised message."""

    topic: str
    msgtype: str
    data: bytes


def camera_messages(name: str, info: SensorInfo, reading: Reading) -> Iterator[ImageMessage]:
    """What one reading of a camera becomes: depth, colour if there is some, and a CameraInfo each.

    Args:
        name: of the sensor: the root of its topics.
        info: of a sensor with a ``camera``.
        reading: depth in m; 0 and inf, for too near and too far, both become 0, which is ROS'
            word for no measurement in ``16UC1``.
    """
    assert info.camera is not None
    head = ros.header(ros.nanoseconds(reading.stamp), optical(info.frame))
    images = {"depth": _image(head, "16UC1", _millimetres(reading.values))}
    if reading.colour is not None:
        images["colour"] = _image(head, "rgb8", reading.colour)
    about = _camera_info(head, info.camera)
    for kind, image in images.items():
        for leaf, message in (("image_raw", image), ("camera_info", about)):
            data = ros.to_cdr(message)
            yield ImageMessage(f"/{name}/{kind}/{leaf}", message.__msgtype__, data)


def _millimetres(depth: Array) -> Any:
    known = np.where(depth <= _FARTHEST, depth, 0.0)
    return np.rint(1000.0 * known).astype("<u2")


def _image(head: Any, encoding: str, pixels: Any) -> Any:
    rows, columns = pixels.shape[:2]
    return ros.new(
        "sensor_msgs/Image",
        header=head,
        height=rows,
        width=columns,
        encoding=encoding,
        is_bigendian=0,
        step=pixels.nbytes // rows,
        data=np.frombuffer(np.ascontiguousarray(pixels).tobytes(), np.uint8),
    )


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
