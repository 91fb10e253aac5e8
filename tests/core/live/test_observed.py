"""Messages of observations in a live run."""

from __future__ import annotations

import numpy as np

from crowdbot.core.live.message import LiveMessage
from crowdbot.core.live.observed import Observed
from crowdbot.core.planning.planner import Observation
from crowdbot.core.recording.covariance import LEAST
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.sensor import Reading
from crowdbot.plugins.sensors.wheel_odometry import WheelOdometrySpec
from crowdbot.plugins.sensors.wheel_odometry_build import WheelOdometry
from crowdbot.testing.sensor_scenes import context


def test_a_live_client_that_comes_late_gets_what_has_grown() -> None:
    """The same as a client from the beginning, whether or not anybody listened before."""
    info = WheelOdometry(WheelOdometrySpec(noise=2.0), context()).info()
    model, found = context().robot, list[LiveMessage]()
    for first in (0, 40):
        live = Observed({"odometry": info}, model)
        for k in range(50):
            t = k / 16
            reading = Reading(t, np.array([0.5 * t, 0.0, 0.0, 0.5, 0.0]))
            obs = Observation(
                t=t, pose=Pose(0.5 * t, 0.0, 0.0), twist=(0.5, 0.0), goal=(9.0, 0.0),
                goal_zone=np.zeros((4, 2)), readings={"odometry": reading},
            )  # fmt: skip
            heard = list(live.messages(obs, {"/odom" if k >= first else ""}.__contains__))
            assert len(heard) == (k >= first)
        found += heard[-1:]
    assert found[0].data == found[1].data
    values = found[0].fields
    assert values.pose.covariance[0] > 3 * LEAST
