"""A live view in Foxglove through its websocket protocol, with foxglove-sdk."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, cast

from crowdbot.core.live.admission import Admission
from crowdbot.core.live.commands import twist
from crowdbot.core.live.foxglove.drawn import THOUGHTS
from crowdbot.core.live.foxglove.gate import FoxgloveGate
from crowdbot.core.live.foxglove.parameters import parameters, set_parameters
from crowdbot.core.live.message import LiveMessage, OfferedTopic
from crowdbot.core.live.robot_topics import namespaces, robot_topic
from crowdbot.core.live.services import Service
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording import template
from crowdbot.core.recording.drawings import drawn_marker, text_markers
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.people import MARKER, PeopleMessages
from crowdbot.core.recording.topics import Topic
from crowdbot.core.recording.viewers import ARROWS_TYPE, PeopleArrows
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command
from crowdbot.errors import InputError

#: Data for spectators, hidden from planners: people, and the true pose of each robot.
SEEN = (
    OfferedTopic(str(Topic.PEOPLE_MARKER), MARKER),
    OfferedTopic(str(Topic.PEOPLE_MARKERS), ARROWS_TYPE),
)
_POSE = "geometry_msgs/msg/PoseStamped"
#: Largest command and request of a client, bytes; largest number of its command topics.
_COMMAND, _REQUEST, _MOST_TOPICS = 4096, 64 << 10, 16
_TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")


class FoxgloveServer:
    """A live connection for Foxglove.

    Commands that Foxglove publishes on ``/cmd_vel``, or ``/NAME/cmd_vel``, drive the robot.
    """

    def __init__(
        self,
        session: LiveSession,
        host: str,
        port: int,
        services: Mapping[str, Service],
        epoch: int = 0,
        admission: Admission | None = None,
    ) -> None:
        """Start listening; ``epoch``: ns added to all stamps.

        Websites are admitted by ``admission``, by default none of others.

        Raises:
            InputError: the address is not available.
        """
        import foxglove
        from foxglove.websocket import Capability

        self._session, self._epoch = session, epoch
        self._people: PeopleMessages | None = None
        self._arrows: PeopleArrows | None = None
        self._pose = template.pose_stamped("map")
        self._poses: dict[str, str] = {}  # topic -> robot
        self._thoughts: dict[str, str] = {}  # robot -> topic
        self._context = foxglove.Context()
        self._channels: dict[str, Any] = {}
        self._latest: dict[str, LiveMessage] = {}
        self._clients: dict[tuple[int, int], tuple[str, str]] = {}  # -> robot, format
        self._lock = threading.Lock()
        start = lambda address: foxglove.start_server(  # noqa: E731
            name="crowdbot",
            host=address,
            port=0,
            capabilities=[
                Capability.ClientPublish,
                Capability.Services,
                Capability.Time,
                Capability.Parameters,
            ],
            server_listener=cast(Any, self),
            supported_encodings=["cdr", "json"],
            services=[_offered(name, service) for name, service in services.items()],
            context=self._context,
        )
        self._gate = FoxgloveGate(host, port, start, admission or Admission(server="foxglove"))
        self._server = self._gate.server

    @property
    def port(self) -> int:
        """Return the port in use."""
        return self._gate.port

    # ---------------------------------------------------------------- the simulation's thread
    def open(self, offers: Sequence[OfferedTopic]) -> None:
        """Start a run that offers these topics."""
        with self._lock:
            self._latest.clear()
        self._make_channels((*offers, *SEEN))
        self._server.publish_parameter_values(parameters(self._session))

    def _make_channels(self, offers: Sequence[OfferedTopic]) -> None:
        from foxglove import Channel, Schema

        for offer in offers:
            if offer.topic not in self._channels:
                kind, text = offer.msgtype, ros.definition(offer.msgtype)
                schema = Schema(name=kind, encoding="ros2msg", data=text)
                self._channels[offer.topic] = Channel(
                    offer.topic, message_encoding="cdr", schema=schema, context=self._context
                )

    def wants(self, topic: str) -> bool:
        """Return True if a client views a topic."""
        channel = self._channels.get(topic)
        return channel is not None and bool(channel.has_sinks())

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        """Send messages to the viewers."""
        for message in messages:
            if message.latched:
                with self._lock:
                    self._latest[message.topic] = message
            channel = self._channels.get(message.topic)
            if channel is not None:
                channel.log(message.data, log_time=message.ns)
        if messages:
            self._server.broadcast_time(max(m.ns for m in messages))

    def begin(self, shared: RecordingHeader, robots: Mapping[str, RecordingHeader]) -> None:
        """Start showing a run's robots and people; see `crowdbot.core.recording.watcher`."""
        agents = shared.agents
        spaces = namespaces(robots)
        self._poses = {robot_topic(str(Topic.POSE), s): name for name, s in spaces.items()}
        self._make_channels([OfferedTopic(topic, _POSE) for topic in self._poses])
        self._thoughts = {name: robot_topic(THOUGHTS, s) for name, s in spaces.items()}
        self._make_channels([OfferedTopic(topic, MARKER) for topic in self._thoughts.values()])
        self._people = None if agents is None else PeopleMessages(agents)
        self._arrows = None if agents is None else PeopleArrows(agents.id, agents.radius)

    def sample(self, t: float, robots: Mapping[str, Sequence[float]], agents: Array | None) -> None:
        """Publish the ground truth to viewers: people, and the true poses of robots."""
        ns = self._epoch + ros.nanoseconds(t)
        for topic, name in self._poses.items():
            if name in robots and self.wants(topic):
                x, y, yaw = robots[name][:3]
                data = self._pose.fill(template.stamp(ns), template.two(x, y), template.turn(yaw))
                self._channels[topic].log(data, log_time=ns)
        for offer in SEEN:
            seen = self._people_seen(offer.topic, ns, agents) if self.wants(offer.topic) else None
            if seen is not None:
                self._channels[offer.topic].log(seen, log_time=ns)

    def drawing(
        self,
        t: float,
        robot: str,
        name: str,
        columns: Array,
        texts: Sequence[str] | None = None,
    ) -> None:
        """Publish a planner's drawing to viewers, as lines or texts."""
        topic = self._thoughts.get(robot)
        if topic is None or not self.wants(topic):
            return
        ns = self._epoch + ros.nanoseconds(t)
        shown = [drawn_marker(ns, name, columns)] if texts is None else (
            text_markers(ns, name, columns, texts)
        )  # fmt: skip
        for data in shown:
            self._channels[topic].log(data, log_time=ns)

    def _people_seen(self, topic: str, ns: int, agents: Array | None) -> bytes | None:
        if agents is None or self._people is None or self._arrows is None:
            return None
        if topic == Topic.PEOPLE_MARKERS:
            return self._arrows.message(ns, agents)
        return self._people.marker(ns, agents)

    def close(self) -> None:
        """Close all connections."""
        self._gate.close()

    # ------------------------------------------------------------------ the server's threads
    def on_subscribe(self, client: Any, channel: Any) -> None:
        """Send latched messages to a new subscriber."""
        del client
        with self._lock:
            message = self._latest.get(channel.topic)
        if message is not None:
            self._channels[channel.topic].log(message.data, log_time=message.ns)
        self._session.listened()

    def on_get_parameters(
        self, client: Any, param_names: list[str], request_id: str | None = None
    ) -> list[Any]:
        """Return the parameters of the run."""
        del client, request_id
        return parameters(self._session, param_names)

    def on_set_parameters(
        self, client: Any, given: list[Any], request_id: str | None = None
    ) -> list[Any]:
        """Pause, restart with another seed, or start another scenario."""
        from foxglove.websocket import StatusLevel

        del client, request_id
        problem = set_parameters(self._session, given)
        if problem:
            self._server.publish_status(problem, StatusLevel.Error)
        return parameters(self._session)

    def on_parameters_subscribe(self, param_names: list[str]) -> None:
        """Do nothing."""

    def on_parameters_unsubscribe(self, param_names: list[str]) -> None:
        """Do nothing."""

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        """Do nothing."""

    def on_client_advertise(self, client: Any, channel: Any) -> None:
        """Register a client's topic."""
        robot = self._session.commands.get(channel.topic)
        if robot is None:
            return
        if sum(owner == client.id for owner, _ in list(self._clients)) >= _MOST_TOPICS:
            self._warn(f"at most {_MOST_TOPICS} topics for a client; {channel.topic} is ignored")
            return
        about = f"{channel.encoding} {channel.schema_name}"
        self._clients[client.id, channel.id] = robot, about
        if not self._session.drive((self, client.id), robot):
            self._warn("another client drives; its commands count until it leaves")

    def _warn(self, text: str) -> None:
        from foxglove.websocket import StatusLevel

        self._server.publish_status(text, StatusLevel.Warning)

    def on_client_unadvertise(self, client: Any, client_channel_id: int) -> None:
        """Remove a client's topic, or a client that is gone."""
        robot, _ = self._clients.pop((client.id, client_channel_id), (None, ""))
        mine = [
            other for (owner, _), (other, _) in list(self._clients.items()) if owner == client.id
        ]
        if robot is not None and robot not in mine:
            self._session.leave((self, client.id), robot)

    def on_message_data(self, client: Any, client_channel_id: int, data: bytes) -> None:
        """Take a command in JSON or CDR; ignore everything else."""
        known = self._clients.get((client.id, client_channel_id))
        if known is None or len(data) > _COMMAND:
            return
        robot, about = known
        encoding, _, kind = about.partition(" ")
        with suppress(Exception):  # third-party decoders with untrusted input
            self._session.command((self, client.id), *_command(encoding, kind, data), robot)


def _command(encoding: str, kind: str, data: bytes) -> tuple[Command, int | None]:
    if encoding == "json":
        return twist(json.loads(data))
    package, _, name = kind.replace("/msg/", "/").partition("/")
    full = f"{package}/msg/{name}"
    if full not in _TWISTS:
        raise InputError(f"{kind} is not a command")
    message = ros.from_cdr(data, full)
    stamp = None
    if full.endswith("Stamped"):
        stamp, message = message.header.stamp, message.twist
        stamp = stamp.sec * 10**9 + stamp.nanosec
    return Command(message.linear.x, message.angular.z, message.linear.y), stamp


async def _awaited(service: Service, values: dict[str, Any]) -> dict[str, Any]:
    return await service.call(values)


def _offered(name: str, service: Service) -> Any:
    """Return a service with requests and responses in JSON."""
    from foxglove import MessageSchema, Schema, ServiceSchema
    from foxglove import Service as Offered

    def schema(part: str, fields: Mapping[str, str]) -> Any:
        text = json.dumps({"type": "object", "properties": {f: {} for f in fields}}).encode()
        inner = Schema(name=f"{service.kind}{part}", encoding="jsonschema", data=text)
        return MessageSchema(encoding="json", schema=inner)

    def call(request: Any) -> bytes:
        answer: dict[str, Any]
        try:
            if len(request.payload) > _REQUEST:
                raise InputError(f"a request has at most {_REQUEST} bytes")
            values = json.loads(request.payload or b"{}")
            if not isinstance(values, dict):
                raise InputError("a request is an object")
            answer = asyncio.run(_awaited(service, values))
        except (InputError, ValueError, RecursionError) as error:
            answer = {"success": False, "message": str(error)}
        return json.dumps(answer).encode()

    described = ServiceSchema(
        name=service.kind,
        request=schema("_Request", service.request),
        response=schema("_Response", service.response),
    )
    return Offered(name=name, schema=described, handler=call)
