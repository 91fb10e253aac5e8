"""The messages of one robot of a live run, on the topics of its namespace."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from crowdbot.core.live.message import LiveMessage, OfferedTopic, live_message
from crowdbot.core.live.observed import Observed
from crowdbot.core.live.robot_topics import robot_topic
from crowdbot.core.live.scene import LiveScene, latched
from crowdbot.core.planning.planner import Observation
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.topics import Topic
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.core.types.task import Task

TopicFilter = Callable[[str], bool]


class RobotMessages:
    """Constant data, and observations step by step.

    Attributes:
        constant: the constant messages.
    """

    def __init__(
        self,
        scene: LiveScene,
        task: Task,
        sensors: Mapping[str, SensorInfo],
        seed: int,
        epoch: int,
    ) -> None:
        """Prepare the messages. ``epoch``: ns added to all stamps."""
        self._space = scene.namespace
        self._observed = Observed(sensors, scene.model, epoch=epoch, namespace=scene.namespace)
        self.constant = list(self._named(latched(scene, task, seed, epoch)))

    def offers(self) -> list[OfferedTopic]:
        """Return the topics of observations, the clock last."""
        offers = self._observed.offers()
        return [replace(o, topic=robot_topic(o.topic, self._space)) for o in offers]

    def messages(self, obs: Observation, subscribed: TopicFilter) -> Iterator[LiveMessage]:
        """Yield new messages, as `Observed.messages`."""
        return self._named(self._observed.messages(obs, self._plain(subscribed)))

    def again(self, obs: Observation, subscribed: TopicFilter) -> Iterator[LiveMessage]:
        """Yield the latest messages, as `Observed.again`."""
        return self._named(self._observed.again(obs, self._plain(subscribed)))

    def _plain(self, subscribed: TopicFilter) -> TopicFilter:
        return lambda topic: subscribed(robot_topic(topic, self._space))

    def _named(self, messages: Iterable[LiveMessage]) -> Iterator[LiveMessage]:
        for message in messages:
            topic = robot_topic(message.topic, self._space)
            yield message if topic == message.topic else replace(message, topic=topic)


def constant_of(robots: Iterable[RobotMessages]) -> list[LiveMessage]:
    """Return the constant messages of all robots; a shared topic has one message for all frames."""
    every = [message for robot in robots for message in robot.constant]
    found: dict[str, LiveMessage] = {}
    for message in every:
        found.setdefault(message.topic, message)
    frames = [m for m in every if m.topic == Topic.TF_STATIC]
    if len(frames) > 1:
        whole = ros.transforms([t for m in frames for t in m.fields.transforms])
        found[Topic.TF_STATIC] = live_message(
            str(Topic.TF_STATIC), frames[0].ns, whole, latched=True
        )
    return list(found.values())


def clock_last(messages: Iterable[LiveMessage]) -> Sequence[LiveMessage]:
    """Return messages of several robots with a single clock message at the end of the step."""
    every = list(messages)
    clocks = [m for m in every if m.topic == Topic.CLOCK]
    return [m for m in every if m.topic != Topic.CLOCK] + clocks[-1:]
