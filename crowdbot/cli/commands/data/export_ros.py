"""``crowdbot export-ros``: export crowdbot's messages and layout for ROS tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from crowdbot.cli.output.say import say
from crowdbot.cli.shared.option import argument


def export_ros(
    folder: Annotated[Path, argument("DIR", "Folder to write to.")],
) -> None:
    """Write the ROS 2 package `crowdbot_msgs`, and a layout for Foxglove and Lichtblick.

    Example: crowdbot export-ros ros2_ws/src
    """
    from importlib.metadata import version

    from crowdbot.core.recording.export.ros_package import LAYOUT, layout, write_package
    from crowdbot.core.support.atomic_write import atomic_write
    from crowdbot.errors import InputError

    try:
        files = write_package(folder, version("crowdbot"))
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror or error}") from error
    path = folder / LAYOUT
    atomic_write(path, layout())
    for file in (*files, path):
        say(str(file))
