"""The rosbridge server: a separate thread with all connections."""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from http import HTTPStatus
from typing import TYPE_CHECKING
from urllib.parse import parse_qs, urlsplit

from crowdbot.core.live.admission import Admission
from crowdbot.core.live.message import LiveMessage, OfferedTopic
from crowdbot.core.live.plain import Ros
from crowdbot.core.live.rosbridge.connection import Connection
from crowdbot.core.live.rosbridge.feed import SubscriptionOptions
from crowdbot.core.live.rosbridge.frames import Frame, encoded
from crowdbot.core.live.rosbridge.pace import Pace
from crowdbot.core.live.rosbridge.rosapi import JOY, TWIST, RosapiWorld, rosapi
from crowdbot.core.live.services import Service
from crowdbot.core.live.session import LiveSession
from crowdbot.core.support.loop_thread import LoopThread
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from websockets.asyncio.server import Server, ServerConnection
    from websockets.http11 import Request, Response

#: Largest frame from a client, and largest amount between two reads, bytes.
_LARGEST, _WAITING = 2**20, 16
_MOST_CLIENTS = 200
#: Largest rate of messages of all clients that do not drive.
_SPECTATORS = 10_000.0
_FAREWELL = 1.0  # s


@dataclass(frozen=True, kw_only=True)
class Address:
    """The address to listen at.

    Attributes:
        port: 0: any free port.
        token: token for clients; empty: none.
        origins: foreign websites that are admitted.
    """

    host: str = "127.0.0.1"
    port: int = 9090
    token: str = ""
    origins: Sequence[str] = ()


class RosbridgeServer:
    """A live connection with the rosbridge protocol."""

    external_clock = False

    def __init__(
        self,
        session: LiveSession,
        address: Address,
        services: Mapping[str, Service],
        *,
        ros: Ros = 2,
        resend: bool = True,
        external_clock: bool = False,
    ) -> None:
        """Start listening.

        Args:
            resend: True to send a new subscriber the latest message of any topic, as needed while
                the simulation waits; otherwise only of latched topics.
            external_clock: True to read ``/clock`` instead of publishing it.

        Raises:
            InputError: the address is not available.
        """
        self.session, self.ros, self.external_clock = session, ros, external_clock
        self._address, self._resend = address, resend
        self._admission = Admission(server="rosbridge", origins=address.origins)
        self.pace = Pace(_SPECTATORS, _SPECTATORS)
        self._world = RosapiWorld(ros=ros, services=dict(services))
        self._world.taken = dict.fromkeys(session.commands, TWIST)
        self._world.taken = {**self._world.taken, **dict.fromkeys(session.joysticks, JOY)}
        self._world.services |= rosapi(self._world)
        self._world.now = lambda: self._now
        if external_clock:
            self._world.taken = {**self._world.taken, "/clock": "rosgraph_msgs/msg/Clock"}
        self._now = 0
        self._latest: dict[str, LiveMessage] = {}
        self._latched = frozenset[str]()
        self._wanted = frozenset[str]()
        self._connections = set[Connection]()
        self._frames: dict[tuple[int, str], tuple[LiveMessage, Frame]] = {}
        self._loop = LoopThread("rosbridge")
        try:
            self._server: Server = self._loop.run(self._start())
        except OSError as error:
            self._loop.close()
            where = f"{address.host}:{address.port}"
            raise InputError(f"{where}: cannot listen there: {error.strerror or error}") from error

    # ---------------------------------------------------------------- the simulation's thread
    @property
    def port(self) -> int:
        """Return the port in use."""
        port: int = next(iter(self._server.sockets)).getsockname()[1]
        return port

    @property
    def services(self) -> Mapping[str, Service]:
        """Return all services, by name."""
        return self._world.services

    def open(self, offers: Sequence[OfferedTopic]) -> None:
        """Start a run that offers these topics."""
        mine = [o for o in offers if not (self.external_clock and o.topic == "/clock")]
        self._loop.soon(self._opened, mine)

    def wants(self, topic: str) -> bool:
        """Return True if a client subscribes to a topic, or new clients get its latest message."""
        return topic in self._wanted or topic in self._latched

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        """Send messages to the listeners."""
        if messages:
            self._loop.soon(self._published, list(messages))

    def close(self) -> None:
        """Close all connections and stop the server."""
        if self._loop.is_closed:
            return
        with suppress(TimeoutError, RuntimeError):
            self._loop.run(self._stop())
        self._loop.close()

    # ------------------------------------------------------------------ the server's thread
    def _opened(self, offers: Sequence[OfferedTopic]) -> None:
        self._world.offers = list(offers)
        self._latest.clear()
        self._latched = frozenset(o.topic for o in offers if o.latched)

    def _published(self, messages: Sequence[LiveMessage]) -> None:
        self._frames.clear()
        for message in messages:
            self._now = max(self._now, message.ns) if self._now else message.ns
            if message.latched or self._resend:
                self._latest[message.topic] = message
        for connection in list(self._connections):
            for message in messages:
                connection.publish(message)

    def latest(self, topic: str) -> LiveMessage | None:
        """Return the message that a new subscriber gets at once."""
        return self._latest.get(topic)

    def changed(self) -> None:
        """Handle changed subscriptions."""
        self._wanted = frozenset(t for c in self._connections for t in c.feeds)

    def encoded(self, message: LiveMessage, options: SubscriptionOptions) -> Frame:
        """Return a message as a frame, shared by all clients with the same format."""
        key = id(message), options.form
        if key not in self._frames:  # the message is kept so that its id is not reused
            self._frames[key] = message, encoded(message, options.form, self.ros)
        return self._frames[key][1]

    async def _start(self) -> Server:
        from websockets.asyncio.server import serve

        quiet = logging.getLogger("crowdbot.rosbridge")
        quiet.setLevel(logging.CRITICAL)
        return await serve(
            self._serve,
            self._address.host,
            self._address.port,
            process_request=self._admitted,
            compression=None,
            max_size=_LARGEST,
            max_queue=_WAITING,
            close_timeout=2.0,
            logger=quiet,
        )

    async def _stop(self) -> None:
        """Send queued frames, above all the last state, within a time limit."""
        end = time.monotonic() + _FAREWELL
        while any(c.waiting for c in self._connections) and time.monotonic() < end:
            await asyncio.sleep(0.005)
        self._server.close()
        await asyncio.wait_for(self._server.wait_closed(), 10.0)

    def _admitted(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return None for allowed clients; pages of foreign websites are refused."""
        if len(self._connections) >= _MOST_CLIENTS:
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "too many clients\n")
        if self._address.token:
            given = parse_qs(urlsplit(request.path).query).get("token", [""])[0]
            header = request.headers.get("Authorization", "").removeprefix("Bearer ")
            known = self._address.token.encode()
            fits = [secrets.compare_digest(x.encode(), known) for x in (given, header)]
            if not any(fits):
                return connection.respond(HTTPStatus.UNAUTHORIZED, "a token is wanted\n")
            return None
        headers = {name: request.headers.get_all(name) for name in ("host", "origin")}
        problem = self._admission.problem(headers)
        return connection.respond(HTTPStatus.FORBIDDEN, f"{problem}\n") if problem else None

    async def _serve(self, socket: ServerConnection) -> None:
        from websockets.exceptions import ConnectionClosed

        connection = Connection(self, socket.send)
        self._connections.add(connection)
        writer = asyncio.get_running_loop().create_task(connection.write())
        try:
            async for frame in socket:
                await connection.take(frame)
        except ConnectionClosed:
            pass
        finally:
            writer.cancel()
            with suppress(asyncio.CancelledError, ConnectionClosed):
                await writer
            self._connections.discard(connection)
            connection.close()
