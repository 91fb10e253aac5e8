"""``crowdbot validate`` finds what only the build of a robot from a file finds."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.cli import main

_DOCUMENT = """\
crowdbot: 1
scenario:
  id: x
  extends: ["builtin:parts/corridor_50x10.yaml"]
  robots:
    robot:
      model:
        kind: urdf
        file: robot.sdf
        base: chassis
        drive: {left: left, right: right, radius: 0.1 m, effort: 4}
        disc: {radius: 0.3 m, height: 0.5 m}
        max_speed: 0.5 m/s
        max_yaw_rate: 2 rad/s
        max_acceleration: 1 m/s^2
        max_yaw_acceleration: 3 rad/s^2
      task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}, time_limit: 5 s}
"""
_SDF = """\
<sdf version="1.6"><model name="m">
  <link name="chassis"><pose>0 0 0.1 0 0 0</pose></link>
  <link name="l"><pose>LEFT 0 1.5707 1.5707</pose></link>
  <link name="r"><pose>0 -0.2 0.1 0 1.5707 1.5707</pose></link>
  <joint name="left" type="revolute"><parent>chassis</parent><child>l</child>
    <axis><xyz>0 0 1</xyz></axis></joint>
  <joint name="right" type="revolute"><parent>chassis</parent><child>r</child>
    <axis><xyz>0 0 1</xyz></axis></joint>
  MORE
</model></sdf>
"""


@pytest.mark.parametrize(
    ("left", "more", "message"),
    [
        ("0 0.2 0.1", "", ""),
        ("0 0.2 0.13", "", "30 mm apart in height"),
        ("0.4 -0.2 0.1", "", "lie along the x axis"),
        ("0 0.2 0.1", "<include><uri>model://camera</uri></include>", "includes 'model://camera'"),
    ],
)
def test_what_a_build_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], left: str, more: str, message: str
) -> None:
    (tmp_path / "robot.sdf").write_text(_SDF.replace("LEFT", left).replace("MORE", more))
    (tmp_path / "s.yaml").write_text(_DOCUMENT)
    assert main(["validate", str(tmp_path / "s.yaml")]) == bool(message)
    shown = capsys.readouterr().err
    assert message in shown
    assert ("s.yaml:8:9: error[E115]" in shown) == bool(message)
