"""A client of an existing rosbridge server, through which ROS nodes drive robots."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from crowdbot.core.live.commands import time_ns, twist
from crowdbot.core.live.message import LiveMessage, OfferedTopic
from crowdbot.core.live.plain import Ros, ros_type
from crowdbot.core.live.rosbridge.bad_frame import BadFrame
from crowdbot.core.live.rosbridge.frames import encoded, parse
from crowdbot.core.live.rosbridge.outbox import Outbox
from crowdbot.core.live.session import LiveSession
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from websockets.asyncio.client import ClientConnection

CLOCK = "/clock"
#: Images are not sent over a text connection.
_LEFT_OUT = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2")
_AGAIN, _FIRST, _LARGEST = 0.5, 20.0, 2**20  # s, s, bytes


class RosbridgeClient:
    """A live connection to an external server, with automatic reconnection."""

    def __init__(
        self, session: LiveSession, uri: str, *, ros: Ros, stamped: bool, external_clock: bool
    ) -> None:
        """Connect.

        Args:
            uri: ``ws://HOST:PORT``.
            stamped: True if commands are TwistStamped.
            external_clock: True to read ``/clock`` instead of publishing it.

        Raises:
            InputError: there is no server.
        """
        self._session, self._uri, self._ros = session, uri, ros
        self._stamped, self._external_clock = stamped, external_clock
        self._offers: dict[str, OfferedTopic] = {}
        self._latest: dict[str, LiveMessage] = {}
        self._known = frozenset[str]()
        self._connected = threading.Event()
        self._ready, self._why = threading.Event(), ""
        self._loop = asyncio.new_event_loop()
        self._outbox = Outbox()
        self._thread = threading.Thread(target=self._run, name="rosbridge client", daemon=True)
        self._thread.start()
        self._ready.wait(_FIRST)
        if not self._connected.is_set():
            self.close()
            raise InputError(f"{uri}: no rosbridge server: {self._why or 'no answer'}")

    # ---------------------------------------------------------------- the simulation's thread
    def open(self, offers: Sequence[OfferedTopic]) -> None:
        """Start a run that offers these topics."""
        mine = [o for o in offers if o.msgtype not in _LEFT_OUT]
        if self._external_clock:
            mine = [o for o in mine if o.topic != CLOCK]
        self._soon(self._opened, mine)
        self._known = frozenset(o.topic for o in mine)

    def wants(self, topic: str) -> bool:
        """Return True: the server gets everything, since it does not report its listeners."""
        return topic in self._known and self._connected.is_set()

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        """Send messages to the server."""
        known = [m for m in messages if m.topic in self._known]
        if known:
            self._soon(self._published, known)

    def close(self) -> None:
        """Disconnect."""
        self._soon(self._end)
        self._thread.join(5.0)

    def _soon(self, callback: Any, *given: object) -> None:
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(callback, *given)

    # ------------------------------------------------------------------ the connection's thread
    def _run(self) -> None:
        self._task = self._loop.create_task(self._stay())
        with suppress(asyncio.CancelledError):
            self._loop.run_until_complete(self._task)
        self._loop.close()

    def _end(self, looks: int = 100) -> None:
        """Disconnect when everything is sent, within half a second."""
        if looks and len(self._outbox) and self._connected.is_set():
            self._loop.call_later(0.005, self._end, looks - 1)
        else:
            self._task.cancel()

    async def _stay(self) -> None:
        from websockets.asyncio.client import connect
        from websockets.exceptions import WebSocketException

        while True:
            try:
                async with connect(self._uri, compression=None, max_size=_LARGEST) as socket:
                    await self._talk(socket)
            except (OSError, WebSocketException, TimeoutError) as error:
                self._why = str(error) or type(error).__name__
            finally:
                self._connected.clear()
                self._session.leave(self)
            if not self._ready.is_set():
                self._ready.set()
                return
            await asyncio.sleep(_AGAIN)

    async def _talk(self, socket: ClientConnection) -> None:
        self._outbox = Outbox()
        self._introduce()
        self._connected.set()
        self._ready.set()
        for robot in self._session.robots:
            self._session.drive(self, robot)
        self._session.listened()
        writer = asyncio.create_task(self._write(socket))
        try:
            async for frame in socket:
                with suppress(BadFrame, InputError):
                    self._take(parse(frame))
        finally:
            writer.cancel()

    async def _write(self, socket: ClientConnection) -> None:
        while True:
            await socket.send(await self._outbox.get())

    def _introduce(self) -> None:
        """Advertise again, since the server forgets disconnected clients."""
        kind = "TwistStamped" if self._stamped else "Twist"
        for topic in self._session.commands:
            self._subscribe(topic, f"geometry_msgs/msg/{kind}")
        if self._external_clock:
            self._subscribe(CLOCK, "rosgraph_msgs/msg/Clock")
        self._advertise(self._offers.values())
        for message in self._latest.values():
            self._outbox.put(encoded(message, "none", self._ros), message.topic)

    def _subscribe(self, topic: str, msgtype: str) -> None:
        kind = ros_type(msgtype, self._ros)
        self._put(op="subscribe", topic=topic, type=kind, queue_length=1)

    def _advertise(self, offers: Any) -> None:
        for offer in offers:
            kind = ros_type(offer.msgtype, self._ros)
            self._put(op="advertise", topic=offer.topic, type=kind, latch=offer.latched)

    def _put(self, **message: Any) -> None:
        self._outbox.put(json.dumps(message))

    def _opened(self, offers: Sequence[OfferedTopic]) -> None:
        new = [o for o in offers if o.topic not in self._offers]
        self._offers = {o.topic: o for o in offers}
        self._latest.clear()
        self._advertise(new)

    def _published(self, messages: Sequence[LiveMessage]) -> None:
        for message in messages:
            if message.latched:
                self._latest[message.topic] = message
            self._outbox.put(encoded(message, "none", self._ros), message.topic)

    def _take(self, message: dict[str, Any]) -> None:
        if message["op"] != "publish":
            return
        robot = self._session.commands.get(str(message.get("topic")))
        if robot is not None:
            command, stamp = twist(message.get("msg"))
            self._session.command(self, command, stamp, robot)
        elif message.get("topic") == CLOCK and self._external_clock:
            body = message.get("msg")
            ns = time_ns(body.get("clock")) if isinstance(body, dict) else None
            if ns is not None:
                self._session.clock(ns / 1e9, self)
