"""Links and joints that a robot's description does not have are errors with their place."""

from __future__ import annotations

from pathlib import Path

import pytest

from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from crowdbot.errors import SpecError

REGISTRY = discover(allow=())
HEAVY = '<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial>'
URDF = f"""\
<robot name="bot"><link name="base_link">{HEAVY}</link><link name="left">{HEAVY}</link>
<link name="right"/><link name="hub">{HEAVY}</link><joint name="cap" type="fixed">
<parent link="right"/><child link="hub"/></joint><joint name="mount" type="fixed">
<parent link="base_link"/><child link="laser"/></joint>
<link name="laser"/><joint name="left_wheel" type="continuous"><parent link="base_link"/>
<child link="left"/></joint><joint name="right_wheel" type="continuous">
<parent link="base_link"/><child link="right"/></joint></robot>
"""
DOCUMENT = """\
crowdbot: 1
scenario:
  id: hall
  extends: ["builtin:parts/corridor_50x10.yaml"]
  robots:
    robot:
      model:
        kind: urdf
        file: bot.urdf
        drive: {left: left_wheel, right: [right_wheel], radius: 0.1 m, effort: 4}
        disc: {radius: 0.25 m, height: 0.9 m}
        max_speed: 0.8 m/s
        max_yaw_rate: 2 rad/s
        max_acceleration: 1 m/s^2
        max_yaw_acceleration: 3 rad/s^2
      sensors: {lidar: {kind: lidar2d, link: laser}, odometry: {kind: wheel_odometry}}
      task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}}
"""


def opened(folder: Path, document: str, urdf: str = URDF) -> None:
    """Open the document beside its URDF, which raises what is wrong."""
    (folder / "bot.urdf").write_text(urdf)
    (folder / "hall.yaml").write_text(document)
    open_spec(str(folder / "hall.yaml"), REGISTRY)


@pytest.mark.parametrize(
    ("written", "wrong", "expected"),
    [
        ("link: laser", "link: lasers", "no link 'lasers'"),
        ("left: left_wheel", "left: left_weel", "no joint 'left_weel'"),
        ("right: [right_wheel]", "right: [right_wheel, rear]", "no joint 'rear'"),
        ("disc:", "positions: {arm: 0.2}\n        disc:", "no joint 'arm'"),
        ("disc:", "base: base\n        disc:", "no link 'base'"),
    ],
)
def test_a_name_that_is_not_there(tmp_path: Path, written: str, wrong: str, expected: str) -> None:
    opened(tmp_path, DOCUMENT)
    document = DOCUMENT.replace(written, wrong)
    with pytest.raises(SpecError) as info:
        opened(tmp_path, document)
    (problem,) = info.value.diagnostics
    assert problem.code == "E130"
    assert expected in problem.message
    assert expected.split("'")[1] in document.splitlines()[problem.mark.line]


@pytest.mark.parametrize(
    ("light", "named"),
    [
        (["left"], "left"), (["base_link"], "base_link"), (["hub"], "right"),
        (["base_link", "left", "hub"], "base_link"),
    ],
)  # fmt: skip
def test_parts_that_move_and_weigh_nothing(tmp_path: Path, light: list[str], named: str) -> None:
    urdf = URDF
    for name in light:
        urdf = urdf.replace(f'<link name="{name}">{HEAVY}</link>', f'<link name="{name}"/>')
    with pytest.raises(SpecError) as info:
        opened(tmp_path, DOCUMENT, urdf)
    (problem,) = info.value.diagnostics
    assert f"link '{named}' weighs nothing, with all that is fixed to it" in problem.message


def test_a_byte_order_mark_hides_nothing(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="no link 'other'"):
        opened(tmp_path, DOCUMENT.replace("link: laser", "link: other"), "\ufeff\n" + URDF)


@pytest.mark.parametrize("urdf", ["<robot", "<sdf/>", URDF.replace('"laser"', '"${laser}"')])
def test_what_only_a_build_reads_is_left_to_it(tmp_path: Path, urdf: str) -> None:
    opened(tmp_path, DOCUMENT.replace("link: laser", "link: other"), urdf)


def test_a_file_of_the_working_directory_is_not_taken_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "bot.urdf").write_text("<robot/>")
    monkeypatch.chdir(elsewhere)
    (tmp_path / "hall.yaml").write_text(DOCUMENT)
    with pytest.raises(SpecError) as info:
        open_spec(str(tmp_path / "hall.yaml"), REGISTRY)
    assert [problem.code for problem in info.value.diagnostics] == ["E201"]
