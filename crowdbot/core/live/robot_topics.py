"""Topics of a live run that belong to one robot."""

from __future__ import annotations

from collections.abc import Collection


def robot_topic(topic: str, robot: str, robots: Collection[str]) -> str:
    """The name of a robot's topic: below the robot's name where there are several."""
    return f"/{robot}{topic}" if len(robots) > 1 else topic
