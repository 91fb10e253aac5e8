"""Joint states and frames of driven wheels, against a rotation by scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from crowdbot.core.recording.joints import WheelMessages

URDF = """<robot name="r">
  <link name="base_link"/><link name="l"/><link name="r"/>
  <joint name="left" type="continuous"><parent link="base_link"/><child link="l"/>
    <origin xyz="0 0.115 0.025" rpy="-1.5 0.2 0.4"/><axis xyz="0 0 2"/></joint>
  <joint name="right" type="continuous"><parent link="base_link"/><child link="r"/>
    <origin xyz="0 -0.115 0.025"/><axis xyz="0 1 0"/></joint>
</robot>"""


def test_states() -> None:
    wheels = WheelMessages(URDF, ("left", "right"), "")
    first, second = wheels.states(0, (0.0, 1.0)), wheels.states(500_000_000, (0.5, 0.0))
    assert first.name == ["left", "right"]
    assert first.velocity.tolist() == [0.0, 0.0]
    assert second.position.tolist() == [0.5, 0.0]
    assert second.velocity.tolist() == [1.0, -2.0]


@pytest.mark.parametrize("angle", [0.0, 1.0, -40.0, 7.3])
def test_frames(angle: float) -> None:
    left, right = WheelMessages(URDF, ("left", "right"), "a").frames(5, (angle, angle)).transforms
    assert (left.header.frame_id, left.child_frame_id) == ("a/base_link", "a/l")
    assert right.transform.translation.y == -0.115
    turn = Rotation.from_euler("xyz", [-1.5, 0.2, 0.4]) * Rotation.from_rotvec([0, 0, angle])
    for frame, expected in ((left, turn), (right, Rotation.from_rotvec([0, angle, 0]))):
        q = frame.transform.rotation
        found = Rotation.from_quat([q.x, q.y, q.z, q.w])
        np.testing.assert_allclose(found.as_matrix(), expected.as_matrix(), atol=1e-12)
