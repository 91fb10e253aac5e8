"""A joystick's topic drives as that of commands does, and is refused where it is not one."""

from __future__ import annotations

import pytest

from crowdbot.core.live.commands import joy
from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.rosbridge.server import Address, RosbridgeServer
from crowdbot.core.live.services import services
from crowdbot.core.live.session import LiveSession
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.errors import InputError
from tests.core.live.live_cases import client, say, until

LIMITS = RobotLimits(v_min=-0.2, v_max=0.8, w_max=1.5, a_max=1.0, alpha_max=2.0)


@pytest.mark.parametrize(
    ("axes", "command"),
    [
        ([0.0, 1.0], Command(0.8, 0.0)),
        ([0.5, -1.0, 0.3], Command(-0.2, 0.75)),
        ([-7.0, 9.0], Command(0.8, -1.5)),
    ],
)
def test_axes_are_deflections(axes: list[float], command: Command) -> None:
    assert joy({"axes": axes}, LIMITS) == pytest.approx(command)


@pytest.mark.parametrize("wrong", [None, {}, {"axes": "ab"}, {"axes": [1.0]}, {"axes": [None, 1]}])
def test_what_is_no_joystick_is_said(wrong: object) -> None:
    with pytest.raises(InputError):
        joy(wrong, LIMITS)


def test_it_drives_by_rosbridge() -> None:
    session = LiveSession(robots={"": LiveRobot(name="robot", limits=LIMITS)})
    server = RosbridgeServer(session, Address(port=0), services(session))
    try:
        with client(server) as one, client(server) as two:
            say(one, "advertise", topic="/joy", type="sensor_msgs/msg/Joy")
            say(one, "publish", topic="/joy", msg={"axes": [0.0, 0.5], "buttons": []})
            until(lambda: session.newest()[0] == Command(0.4, 0.0))
            say(two, "publish", topic="/joy", msg={"axes": [1.0, 1.0]})
            until(lambda: session.counts.refused == 1)
            assert session.newest()[0] == Command(0.4, 0.0)
            say(one, "unadvertise", topic="/joy")
            until(lambda: not session.is_driven(""))
    finally:
        server.close()
