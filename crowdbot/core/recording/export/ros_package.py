"""The ROS 2 package with crowdbot's messages and services, and a layout for Foxglove."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from crowdbot.core.recording.definitions import DEFINITIONS, LIVE_DEFINITIONS

NAME = "crowdbot_msgs"
#: Ships with the package.
LAYOUT = "crowdbot_layout.json"
SERVICES = {
    "Step": "uint32 steps\n---\nbool success\nstring message",
    "SetSeed": "int64 seed\n---\nbool success\nstring message",
}
_PACKAGE = """\
<?xml version="1.0"?>
<package format="3">
  <name>crowdbot_msgs</name>
  <version>{version}</version>
  <description>Messages in recordings and live runs of crowdbot.</description>
  <maintainer email="crowdbot@example.org">The crowdbot developers</maintainer>
  <license>BSD-3-Clause</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>std_msgs</depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
_CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(crowdbot_msgs)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
find_package(std_msgs REQUIRED)
rosidl_generate_interfaces(${{PROJECT_NAME}}
{files}
  DEPENDENCIES std_msgs)
ament_export_dependencies(rosidl_default_runtime)
ament_package()
"""


def write_package(folder: Path, version: str) -> list[Path]:
    """Write the package's files to ``folder/crowdbot_msgs``; return their paths."""
    root = folder / NAME
    texts = {f"msg/{n}.msg": t for n, t in {**DEFINITIONS, **LIVE_DEFINITIONS}.items()}
    texts |= {f"srv/{n}.srv": t for n, t in SERVICES.items()}
    names = "\n".join(f'  "{name}"' for name in texts)
    texts = {n: f"{t.replace(f'{NAME}/', '')}\n" for n, t in texts.items()}
    texts |= {
        "package.xml": _PACKAGE.format(version=version),
        "CMakeLists.txt": _CMAKE.format(files=names),
    }
    written = []
    for name, text in texts.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        written.append(path)
    return written


def layout() -> str:
    """Return a layout for Foxglove and Lichtblick, which hide topics without one."""
    return (files(__package__) / LAYOUT).read_text(encoding="utf-8")
