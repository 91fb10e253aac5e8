"""`crowdbot export-ros`: the package has every type, as the recordings have it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from crowdbot import cli
from crowdbot.core.recording.definitions import DEFINITIONS, LIVE_DEFINITIONS
from crowdbot.core.recording.messages import type_hash


def test_the_package_has_the_types_of_the_recordings(tmp_path: Path) -> None:
    assert cli.main(["export-ros", str(tmp_path)]) == 0
    package = tmp_path / "crowdbot_msgs"
    store, types = get_typestore(Stores.ROS2_JAZZY), {}
    for file in (package / "msg").glob("*.msg"):
        types.update(get_types_from_msg(file.read_text(), f"crowdbot_msgs/msg/{file.stem}"))
    store.register(types)
    assert set(types) == {f"crowdbot_msgs/msg/{n}" for n in {**DEFINITIONS, **LIVE_DEFINITIONS}}
    for name in types:
        assert type_hash(name) == f"RIHS01_{store.hash_rihs01(name).removeprefix('RIHS01_')}"
    cmake = (package / "CMakeLists.txt").read_text()
    for file in [*package.glob("msg/*"), *package.glob("srv/*")]:
        assert f'"{file.relative_to(package)}"' in cmake
    assert "<name>crowdbot_msgs</name>" in (package / "package.xml").read_text()


def test_the_layout_names_panels_that_it_has(tmp_path: Path) -> None:
    assert cli.main(["export-ros", str(tmp_path)]) == 0
    layout = json.loads((tmp_path / "crowdbot_layout.json").read_text())
    panels = {layout["layout"]["first"], layout["layout"]["second"]}
    assert panels == set(layout["configById"])
    assert layout["configById"]["3D!scene"]["topics"]["/pedestrians_marker"]["visible"]


def test_a_folder_that_cannot_be_written_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.write_text("x")
    assert cli.main(["export-ros", str(file)]) == 1
    assert "cannot be written" in capsys.readouterr().err


def test_info_names_the_tool_for_a_bag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "metadata.yaml").write_text("rosbag2_bagfile_information: {}")
    assert cli.main(["info", str(tmp_path)]) == 1
    assert f"is a bag for ROS: 'ros2 bag info {tmp_path}'" in capsys.readouterr().err
