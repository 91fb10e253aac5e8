"""One client of the rosbridge server: its requests and messages."""

from __future__ import annotations

import asyncio
import itertools
import json
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any, Protocol

from crowdbot.core.live.commands import time_ns, twist
from crowdbot.core.live.message import LiveMessage
from crowdbot.core.live.rosbridge.bad_frame import BadFrame
from crowdbot.core.live.rosbridge.feed import Feed, SubscriptionOptions, subscription_options
from crowdbot.core.live.rosbridge.fragments import Joiner, split
from crowdbot.core.live.rosbridge.frames import Frame, parse
from crowdbot.core.live.rosbridge.outbox import Outbox
from crowdbot.core.live.rosbridge.pace import Pace, cost_of
from crowdbot.core.live.services import Service
from crowdbot.core.live.session import LiveSession
from crowdbot.errors import InputError

CLOCK = "/clock"
_LEVELS = {"none": -1, "error": 0, "warning": 1, "info": 2}
#: Limits of subscriptions, topics and parallel service calls per client.
_MOST_TOPICS, _MOST_CALLS = 1000, 64
#: Largest rate of messages per client; above it, messages wait in the socket.
_PER_SECOND, _BURST = 5000.0, 5000.0


class Hub(Protocol):
    """The part of the server that a connection uses."""

    session: LiveSession
    external_clock: bool
    pace: Pace

    @property
    def services(self) -> Mapping[str, Service]:
        """Return all services, by name."""
        ...

    def latest(self, topic: str) -> LiveMessage | None:
        """Return the message that a new subscriber gets at once."""
        ...

    def changed(self) -> None:
        """Handle changed subscriptions."""
        ...

    def encoded(self, message: LiveMessage, options: SubscriptionOptions) -> Frame:
        """Return a message as a frame, shared by all clients with the same format."""
        ...


class Connection:
    """A client; used only in the server's thread."""

    def __init__(self, hub: Hub, send: Callable[[Frame], Awaitable[None]]) -> None:
        self._hub, self._send = hub, send
        self.feeds: dict[str, Feed] = {}
        self._outbox, self._sending = Outbox(), False
        self._joiner = Joiner()
        self._numbers = itertools.count()
        self._level = _LEVELS["error"]
        self._advertised = dict[str, int]()
        self._calls = set[asyncio.Task[None]]()
        self._own_pace = Pace(_PER_SECOND, _BURST)
        self._ops: dict[str, Callable[[Mapping[str, Any]], None]] = {
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "advertise": self._advertise,
            "unadvertise": self._unadvertise,
            "publish": self._publish,
            "call_service": self._call_service,
            "fragment": self._fragment,
            "set_level": self._set_level,
            "status": lambda _: None,
            "auth": lambda _: None,
        }

    # ------------------------------------------------------------------------- incoming
    async def take(self, frame: Frame) -> None:
        """Handle a frame; never raises."""
        wait = self._own_pace.take(cost_of(frame))
        if not self._hub.session.drives(self):  # spectators share what drivers leave
            wait = max(wait, self._hub.pace.take(cost_of(frame)))
        if wait > 0.0:
            await asyncio.sleep(wait)
        self._do(frame)

    def _do(self, frame: Frame) -> None:
        message: dict[str, Any] = {}
        try:
            message = parse(frame)
            op = self._ops.get(message["op"])
            if op is None:
                raise BadFrame(f"unknown op '{message['op'][:40]}'")
            op(message)
        except (BadFrame, InputError) as error:
            self._tell("error", str(error), message.get("id"))
        except (ValueError, TypeError, KeyError, RecursionError, OverflowError) as error:
            self._tell("error", f"not understood: {type(error).__name__}", message.get("id"))

    def _subscribe(self, message: Mapping[str, Any]) -> None:
        topic = _topic(message)
        options, remark = subscription_options(message)
        if remark:
            self._tell("warning", remark, message.get("id"))
        feed = self.feeds.get(topic)
        if feed is None:
            self._room(self.feeds)
            later = asyncio.get_running_loop().call_later
            feed = self.feeds[topic] = Feed(self._pass_on, later, time.monotonic)
        feed.subscribe(_name(message), options)
        self._hub.changed()
        last = self._hub.latest(topic)
        if last is not None:
            feed.take(last)
        self._hub.session.listened()

    def _unsubscribe(self, message: Mapping[str, Any]) -> None:
        topic = _topic(message)
        feed = self.feeds.get(topic)
        if feed is not None and feed.unsubscribe(_name(message) or None):
            del self.feeds[topic]
            self._hub.changed()

    def _advertise(self, message: Mapping[str, Any]) -> None:
        topic = _topic(message)
        self._room(self._advertised)
        self._advertised[topic] = self._advertised.get(topic, 0) + 1
        robot = self._driven_by(topic)
        if robot is not None and not self._hub.session.drive(self, robot):
            self._tell("warning", "another client drives; its commands count until it leaves")

    def _unadvertise(self, message: Mapping[str, Any]) -> None:
        topic = _topic(message)
        self._advertised.pop(topic, None)
        robot = self._driven_by(topic)
        if robot is not None:
            self._hub.session.leave(self, robot)

    def _driven_by(self, topic: str) -> str | None:
        """Return the robot that a topic drives, by namespace."""
        session = self._hub.session
        return session.commands.get(topic, session.joysticks.get(topic))

    def _publish(self, message: Mapping[str, Any]) -> None:
        topic = _topic(message)
        robot = self._hub.session.commands.get(topic)
        if robot is not None:
            command, stamp = twist(message.get("msg"))
            why = self._hub.session.command(self, command, stamp, robot)
            if why:
                self._tell("warning", why, message.get("id"))
        elif (robot := self._hub.session.joysticks.get(topic)) is not None:
            why = self._hub.session.joystick(self, message.get("msg"), robot)
            if why:
                self._tell("warning", why, message.get("id"))
        elif topic == CLOCK and self._hub.external_clock:
            body = message.get("msg")
            ns = time_ns(body.get("clock")) if isinstance(body, Mapping) else None
            if ns is None:
                raise BadFrame("a clock is a rosgraph_msgs/Clock")
            if not self._hub.session.clock(ns / 1e9, self):
                self._tell("warning", "another client keeps the clock until it leaves")

    def _fragment(self, message: Mapping[str, Any]) -> None:
        whole = self._joiner.add(message)
        if whole is not None:
            inner = parse(whole)
            if inner["op"] == "fragment":
                raise BadFrame("a fragment of fragments")
            self._do(whole)

    def _set_level(self, message: Mapping[str, Any]) -> None:
        level = message.get("level")
        if level not in _LEVELS:
            raise BadFrame(f"'level' is one of {', '.join(_LEVELS)}")
        self._level = _LEVELS[level]

    def _call_service(self, message: Mapping[str, Any]) -> None:
        if len(self._calls) >= _MOST_CALLS:
            raise BadFrame("too many calls at once")
        task = asyncio.get_running_loop().create_task(self._answer(dict(message)))
        self._calls.add(task)
        task.add_done_callback(self._calls.discard)

    async def _answer(self, message: dict[str, Any]) -> None:
        name, given = message.get("service"), message.get("args")
        response = {"op": "service_response", "service": name, "result": True}
        if "id" in message:
            response["id"] = message["id"]
        try:
            service = self._hub.services.get(name) if isinstance(name, str) else None
            if service is None:
                raise InputError(f"there is no service '{str(name)[:80]}'")
            response["values"] = await service.call(_arguments(service, given))
        except InputError as error:
            response |= {"result": False, "values": str(error)}
        self._outbox.put(json.dumps(response))

    # ------------------------------------------------------------------------- outgoing
    def publish(self, message: LiveMessage) -> None:
        """Send a message if subscribed."""
        feed = self.feeds.get(message.topic)
        if feed is not None:
            feed.take(message)

    def _pass_on(self, message: LiveMessage, options: SubscriptionOptions) -> None:
        frame = self._hub.encoded(message, options)
        if options.fragment and isinstance(frame, str):
            try:
                for piece in split(frame, options.fragment, next(self._numbers)):
                    self._outbox.put(piece)
            except BadFrame as error:
                self._tell("error", f"{message.topic}: {error}")
        else:
            self._outbox.put(frame, message.topic, options.queue)

    def _tell(self, level: str, text: str, about: object = None) -> None:
        if _LEVELS[level] <= self._level:
            message: dict[str, Any] = {"op": "status", "level": level, "msg": text}
            if isinstance(about, str | int):
                message["id"] = about
            self._outbox.put(json.dumps(message))

    async def write(self) -> None:
        """Send queued frames forever."""
        while True:
            frame = await self._outbox.get()
            self._sending = True
            await self._send(frame)
            self._sending = False

    @property
    def waiting(self) -> bool:
        """Return True if frames are queued."""
        return self._sending or len(self._outbox) > 0

    def close(self) -> None:
        """Handle a disconnected client."""
        for task in self._calls:
            task.cancel()
        for feed in self.feeds.values():
            feed.unsubscribe(None)
        self.feeds.clear()
        self._hub.session.leave(self)
        self._hub.changed()

    def _room(self, topics: Mapping[str, Any]) -> None:
        if len(topics) >= _MOST_TOPICS:
            raise BadFrame("too many topics")


def _topic(message: Mapping[str, Any]) -> str:
    topic = message.get("topic")
    if not isinstance(topic, str) or not topic or len(topic) > 256:
        raise BadFrame("'topic' is missing")
    return topic if topic.startswith("/") else f"/{topic}"


def _name(message: Mapping[str, Any]) -> str:
    name = message.get("id", "")
    return str(name)[:256] if isinstance(name, str | int) else ""


def _arguments(service: Service, given: object) -> dict[str, Any]:
    """Return arguments by name, or in order."""
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return {str(k): v for k, v in given.items()}
    if isinstance(given, list) and len(given) <= len(service.request):
        return dict(zip(service.request, given, strict=False))
    raise InputError("'args' is an object, or a list with as many values as the service has fields")
