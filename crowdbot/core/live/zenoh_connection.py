"""ROS 2 topics without ROS: the wire format of rmw_zenoh, through eclipse-zenoh."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any

import crowdbot.core.live.ros2_keys as ros2_keys
from crowdbot.core.live.message import LiveMessage, OfferedTopic
from crowdbot.core.live.services import Service
from crowdbot.core.live.session import LiveSession
from crowdbot.core.live.zenoh_publishers import ZenohPublishers
from crowdbot.core.live.zenoh_services import ZenohServices
from crowdbot.core.recording import messages as ros
from crowdbot.core.types.motion import Command
from crowdbot.errors import InputError

CLOCK = "/clock"
TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
JOY = "sensor_msgs/msg/Joy"
_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
_NODE = "crowdbot"


@dataclass(frozen=True, kw_only=True)
class Network:
    """Address, domain and distribution of the ROS 2 network.

    Attributes:
        endpoint: address of the router, ``tcp/HOST:PORT``.
        router: True to be the router instead of connecting to one.
        domain: as in ``ROS_DOMAIN_ID``.
        distro: distribution of the type hashes in keys.
    """

    endpoint: str = "tcp/127.0.0.1:7447"
    router: bool = False
    domain: int = 0
    distro: ros2_keys.Distro = "jazzy"


class _Publisher:
    """A topic as eclipse-zenoh publishes it."""

    def __init__(self, topic: ros2_keys.Ros2Topic, publisher: Any, token: Any, gid: bytes) -> None:
        self.topic, self.publisher, self.token = topic, publisher, token
        self._gid, self._sequence = gid, itertools.count(1)
        self.has_readers = topic.latched
        self.latest: LiveMessage | None = None

    def put(self, message: LiveMessage, distro: ros2_keys.Distro) -> None:
        about = ros2_keys.attachment(next(self._sequence), message.ns, self._gid)
        data = ros2_keys.in_distro(message.data, message.msgtype, distro)
        self.publisher.put(data, attachment=about)

    def undeclare(self) -> None:
        self.publisher.undeclare()
        self.token.undeclare()


class ZenohConnection:
    """A live connection with the protocol of ROS 2 nodes with rmw_zenoh."""

    def __init__(
        self,
        session: LiveSession,
        network: Network,
        services: Mapping[str, Service] = MappingProxyType({}),
        *,
        resend: bool = True,
        external_clock: bool,
    ) -> None:
        """Connect.

        Raises:
            InputError: there is no router at the endpoint, or it cannot be started.
        """
        self._session, self._network = session, network
        self._resend, self._external_clock = resend, external_clock
        self._zenoh = _opened(network)
        self._name = str(self._zenoh.zid())
        self._entities = itertools.count(10)
        self._publishers: dict[str, _Publisher] = {}
        self._lock = threading.Lock()
        self._drivers = {robot: ZenohPublishers() for robot in session.robots}
        self._clocks = ZenohPublishers()
        live = self._zenoh.liveliness()
        self._kept: list[Any] = [
            live.declare_token(ros2_keys.node_token(network.domain, self._name, _NODE))
        ]
        for name, robot in session.commands.items():
            self._hear(name, TWIST, partial(self._on_twist, robot))
            self._hear(name, STAMPED, partial(self._on_stamped, robot))
        for name, robot in session.joysticks.items():
            self._hear(name, JOY, partial(self._on_joy, robot))
        if external_clock:
            self._hear(CLOCK, _CLOCK_TYPE, self._on_clock)
            fits = ros2_keys.drivers_of(network.domain, CLOCK)
            self._kept.append(live.declare_subscriber(fits, self._on_keeper, history=True))
        self._servers = ZenohServices(self._zenoh)
        for name, service in services.items():
            topic = self._servers.serve(name, service, network.domain, network.distro)
            self._say_there(topic, ros2_keys.SERVER)
        for name, robot in {**session.commands, **session.joysticks}.items():
            fits, came = ros2_keys.drivers_of(network.domain, name), partial(self._on_driver, robot)
            self._kept.append(live.declare_subscriber(fits, came, history=True))

    # ---------------------------------------------------------------- the simulation's thread
    def open(self, offers: Sequence[OfferedTopic]) -> None:
        """Start a run that offers these topics."""
        names = {o.topic for o in offers}
        for name in [n for n in self._publishers if n not in names]:
            self._publishers.pop(name).undeclare()
        for offer in offers:
            if offer.topic in self._publishers:
                self._publishers[offer.topic].latest = None
            elif not (self._external_clock and offer.topic == CLOCK):
                self._publishers[offer.topic] = self._declare(offer)

    def wants(self, topic: str) -> bool:
        """Return True if a client listens to a topic."""
        found = self._publishers.get(topic)
        return found is not None and found.has_readers

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        """Send messages to the listeners."""
        for message in messages:
            found = self._publishers.get(message.topic)
            if found is not None:
                with self._lock:
                    found.latest = message
                    found.put(message, self._network.distro)

    def close(self) -> None:
        """Disconnect."""
        self._servers.close()
        if not self._zenoh.is_closed():
            self._zenoh.close()

    def _topic(self, name: str, msgtype: str, *, latched: bool = False) -> ros2_keys.Ros2Topic:
        return ros2_keys.Ros2Topic(
            name, msgtype, ros2_keys.hash_in(msgtype, self._network.distro), latched
        )

    def _declare(self, offer: OfferedTopic) -> _Publisher:
        topic = self._topic(offer.topic, offer.msgtype, latched=offer.latched)
        key, domain = topic.key(self._network.domain), self._network.domain
        text = topic.token(domain, self._name, next(self._entities), ros2_keys.PUBLISHER, _NODE)
        token = self._zenoh.liveliness().declare_token(text)
        if offer.latched:
            from zenoh import ext

            cache = ext.CacheConfig(max_samples=1)
            made: Any = ext.declare_advanced_publisher(self._zenoh, key, cache=cache)
            return _Publisher(topic, made, token, ros2_keys.gid_of(text))
        made = self._zenoh.declare_publisher(key)
        publisher = _Publisher(topic, made, token, ros2_keys.gid_of(text))
        made.declare_matching_listener(lambda status: self._on_listener(publisher, status))
        publisher.has_readers = bool(made.matching_status.matching)
        return publisher

    # ----------------------------------------------------------------------- zenoh's threads
    def _hear(self, name: str, msgtype: str, heard: Any) -> None:
        topic = self._topic(name, msgtype)
        self._kept.append(self._zenoh.declare_subscriber(topic.key(self._network.domain), heard))
        self._say_there(topic, ros2_keys.SUBSCRIPTION)

    def _say_there(self, topic: ros2_keys.Ros2Topic, kind: str) -> None:
        domain, number = self._network.domain, next(self._entities)
        text = topic.token(domain, self._name, number, kind, _NODE)
        self._kept.append(self._zenoh.liveliness().declare_token(text))

    def _on_listener(self, publisher: _Publisher, status: Any) -> None:
        publisher.has_readers = bool(status.matching)
        if not publisher.has_readers:
            return
        with self._lock:
            if self._resend and publisher.latest is not None:
                publisher.put(publisher.latest, self._network.distro)
        self._session.listened()

    def _on_driver(self, robot: str, sample: Any) -> None:
        """Handle a command publisher that came or left."""
        import zenoh

        key = str(sample.key_expr)
        if sample.kind == zenoh.SampleKind.PUT:
            self._drivers[robot].came(key)
            self._session.drive(self, robot)
        elif self._drivers[robot].left(key):
            self._session.leave(self, robot)

    def _on_keeper(self, sample: Any) -> None:
        """Handle a clock publisher that came or left."""
        import zenoh

        key = str(sample.key_expr)
        if sample.kind == zenoh.SampleKind.PUT:
            self._clocks.came(key)
        elif self._clocks.left(key):
            self._session.leave_clock(self)

    def _on_twist(self, robot: str, sample: Any) -> None:
        message = _read(sample, TWIST)
        if message is not None:
            self._command(robot, sample, message, None)

    def _on_stamped(self, robot: str, sample: Any) -> None:
        message = _read(sample, STAMPED)
        if message is not None:
            stamp = message.header.stamp
            self._command(robot, sample, message.twist, stamp.sec * 10**9 + stamp.nanosec)

    def _on_joy(self, robot: str, sample: Any) -> None:
        message = _read(sample, JOY)
        if message is None or not self._drivers[robot].may(sample):
            return
        with suppress(InputError):
            self._session.joystick(self, {"axes": message.axes.tolist()}, robot)

    def _command(self, robot: str, sample: Any, twist: Any, stamp: int | None) -> None:
        if not self._drivers[robot].may(sample):
            self._session.refuse()
            return
        command = Command(twist.linear.x, twist.angular.z, twist.linear.y)
        self._session.command(self, command, stamp, robot)

    def _on_clock(self, sample: Any) -> None:
        message = _read(sample, _CLOCK_TYPE)
        if message is not None and self._clocks.may(sample):
            self._session.clock(message.clock.sec + message.clock.nanosec / 1e9, self)


def _read(sample: Any, msgtype: str) -> Any | None:
    """Return the message; None for invalid bytes."""
    try:
        return ros.from_cdr(sample.payload.to_bytes(), msgtype)
    except Exception:  # generated code with untrusted input
        return None


def _opened(network: Network) -> Any:
    import zenoh

    config = zenoh.Config()
    where = "listen/endpoints" if network.router else "connect/endpoints"
    config.insert_json5("mode", '"router"' if network.router else '"client"')
    config.insert_json5("scouting/multicast/enabled", "false")
    try:
        config.insert_json5(where, f'["{network.endpoint}"]')
        return zenoh.open(config)
    except Exception as error:  # always zenoh.ZError, with a technical text
        doing = "be a router at" if network.router else "find a router of ROS 2 at"
        raise InputError(f"{network.endpoint}: cannot {doing} that endpoint") from error
