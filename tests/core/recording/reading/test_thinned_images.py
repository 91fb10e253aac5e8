"""Images as the replay page shows them: fewer and smaller, and the page is the same."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.reading.images import ReplayImages
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.core.runs.replayed import images_of_replay
from crowdbot.core.types.sensor import CameraFrame, Pinhole, SensorInfo

PERIOD = 1 / 8  # s


def _record(
    path: Path, record: Literal["all", "used", "none"], width: int, height: int
) -> list[bool]:
    """A second of images; of which the writer asked to have them."""
    info = SensorInfo(
        category="camera", rate=1 / PERIOD, shape=(height, width), ros_type="sensor_msgs/msg/Image",
        frame="eye", mount=(0.0, 0.0, 0.3, 0.0),
        camera=Pinhole(width=width, height=height, focal=150.0, colour=True),
    )  # fmt: skip
    writer = RecordingWriter(
        path, RecordingHeader(scenario="x", sensors={"eye": info}), record=record
    )
    rng, wanted = np.random.default_rng(3), []
    for k in range(9):
        depth = rng.integers(0, 2**16, (height, width), np.uint16)
        colour = rng.integers(0, 256, (height, width, 3), np.uint8)
        wanted.append(writer.wants_frame("eye", k * PERIOD))
        writer.frame("eye", CameraFrame(k * PERIOD, depth, colour))
    writer.close(None, True, "timeout")
    return wanted


def _page(path: Path) -> list[ReplayImages]:
    collector = images_of_replay(path)
    for message in Records(path):
        collector.add(message)
    return collector.images()


def _messages(path: Path, leaf: str) -> list[Any]:
    with AnyReader([path]) as reader:
        return [
            reader.deserialize(data, connection.msgtype)
            for connection, _, data in reader.messages()
            if connection.topic == f"/eye/depth/{leaf}"
        ]


@pytest.mark.parametrize(("width", "height"), [(320, 240), (97, 5), (96, 4), (7, 300), (200, 1)])
def test_the_page_is_the_same(tmp_path: Path, width: int, height: int) -> None:
    assert _record(tmp_path / "all.mcap", "all", width, height) == [True] * 9
    assert _record(tmp_path / "used.mcap", "used", width, height) == [k % 4 == 0 for k in range(9)]
    assert _record(tmp_path / "none.mcap", "none", width, height) == [False] * 9
    whole, less = _page(tmp_path / "all.mcap"), _page(tmp_path / "used.mcap")
    assert [image.kind for image in less] == ["depth", "colour"]
    for a, b in zip(whole, less, strict=True):
        assert (a.t.tobytes(), a.pixels.shape) == (b.t.tobytes(), b.pixels.shape)
        assert a.pixels.tobytes() == b.pixels.tobytes()
    assert not _page(tmp_path / "none.mcap")


def test_pixels_look_where_camera_info_says(tmp_path: Path) -> None:
    """A pixel that was kept lies on the same ray as in the whole image."""
    rays = {}
    for record in ("all", "used"):
        path = tmp_path / f"{record}.mcap"
        _record(path, record, 320, 240)
        image, about = (_messages(path, leaf)[0] for leaf in ("image_raw", "camera_info"))
        assert (about.width, about.height) == (image.width, image.height)
        pixels = image.data.view("<u2").reshape(image.height, image.width)
        k = about.k.reshape(3, 3)
        columns = (np.arange(image.width) - k[0, 2]) / k[0, 0]
        rows = (np.arange(image.height) - k[1, 2]) / k[1, 1]
        rays[record] = columns, rows, pixels
    (xs, ys, whole), (x, y, less) = rays["all"], rays["used"]
    assert less.shape == (60, 80)
    j = [int(np.argmin(np.abs(xs - one))) for one in x]
    i = [int(np.argmin(np.abs(ys - one))) for one in y]
    np.testing.assert_allclose(xs[j], x, atol=1e-12)
    np.testing.assert_allclose(ys[i], y, atol=1e-12)
    np.testing.assert_array_equal(whole[np.ix_(i, j)], less)
