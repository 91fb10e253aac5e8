"""Topics of each robot in a live run: without a prefix for a single robot, else ``/NAME/…``."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from crowdbot.core.recording.topics import Topic

STATUS, COMMAND, JOY = "/crowdbot/status", str(Topic.COMMAND), "/joy"
#: Topics that all robots share, as in recordings.
_SHARED = frozenset(
    {STATUS, Topic.TF, Topic.TF_STATIC, Topic.CLOCK, Topic.MAP, Topic.WALLS}
)  # fmt: skip


def namespaces(robots: Collection[str]) -> dict[str, str]:
    """Return the namespace of each robot of a scenario: its name, or empty for the only one."""
    return {name: name if len(robots) > 1 else "" for name in robots}


def robot_topic(topic: str, namespace: str) -> str:
    """Return the name of a robot's topic."""
    return f"/{namespace}{topic}" if namespace and topic not in _SHARED else topic


def command_topics(names: Iterable[str]) -> dict[str, str]:
    """Return the topics of commands: topic -> namespace of the robot."""
    return {robot_topic(COMMAND, name): name for name in names}


def joy_topics(names: Iterable[str]) -> dict[str, str]:
    """Return the topics of joysticks: topic -> namespace of the robot."""
    return {robot_topic(JOY, name): name for name in names}
