"""Cameras of third parties that have whole millimetres are watched like all their sensors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.interfaces import MillimetreCamera
from crowdbot.core.sensing.guard import Watched, WatchedCamera
from crowdbot.errors import PluginError
from crowdbot.plugins.sensors.rgbd_camera import RgbdCameraSpec
from crowdbot.plugins.sensors.rgbd_camera_build import RgbdCamera

GIVEN = ("scene", "pose", 0.125, "rng")


class Camera(RgbdCamera):
    """Returns what it is told to, or raises it."""

    answer: Any = None

    def millimetres(self, *given: Any) -> Any:
        assert given == GIVEN
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


def watched(answer: Any) -> WatchedCamera:
    camera = Camera(RgbdCameraSpec(width=3, height=2))
    camera.answer = answer
    return WatchedCamera("acme.camera", camera, camera.info())


def test_sound_images_go_through() -> None:
    image = np.full((2, 3), 700, np.uint16)
    camera = watched(image)
    assert isinstance(camera, MillimetreCamera)
    kept = camera.millimetres(*GIVEN)
    np.testing.assert_array_equal(kept, image)
    image[:] = 0  # a camera that uses its memory again
    assert np.all(kept == 700)
    assert not isinstance(Watched("x", camera, camera.info()), MillimetreCamera)


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (np.zeros((3, 2), np.uint16), r"returned uint16 \(3, 2\), not uint16 \(2, 3\)"),
        (np.zeros((2, 3)), r"returned float64 \(2, 3\)"),
        (None, r"returned NoneType \(\)"),
        (ValueError("fog"), r"acme.camera at t = 0.125 s: ValueError: fog"),
    ],
)
def test_others_are_an_error(answer: Any, said: str) -> None:
    with pytest.raises(PluginError, match=said):
        watched(answer).millimetres(*GIVEN)
