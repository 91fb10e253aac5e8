"""A server without a simulation behind it, and clients of it."""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from websockets.sync.client import ClientConnection, connect

from crowdbot.core.live.message import LiveMessage, OfferedTopic, live_message
from crowdbot.core.live.rosbridge.server import Address, RosbridgeServer
from crowdbot.core.live.services import services
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording import messages as ros

CLOCK = OfferedTopic("/clock", "rosgraph_msgs/msg/Clock")
AT_MOST = 60.0
_NUMBERS = itertools.count()


def clock(ns: int) -> LiveMessage:
    return live_message("/clock", ns, ros.clock(ns))


@contextmanager
def serving(token: str = "", **more: Any) -> Iterator[tuple[RosbridgeServer, LiveSession]]:
    session = LiveSession()
    server = RosbridgeServer(session, Address(port=0, token=token), services(session), **more)
    try:
        server.open([CLOCK])
        yield server, session
    finally:
        server.close()


@contextmanager
def client(server: RosbridgeServer, path: str = "", **more: Any) -> Iterator[ClientConnection]:
    uri = f"ws://127.0.0.1:{server.port}/{path}"
    with connect(uri, compression=None, open_timeout=AT_MOST, close_timeout=1.0, **more) as socket:
        yield socket


def say(socket: ClientConnection, op: str, **fields: Any) -> None:
    socket.send(json.dumps({"op": op, **fields}))


def hear(socket: ClientConnection) -> dict[str, Any]:
    return dict(json.loads(socket.recv(timeout=AT_MOST)))


def call(socket: ClientConnection, service: str, args: Any = None) -> dict[str, Any]:
    name = f"call {next(_NUMBERS)}"
    given = {} if args is None else {"args": args}
    say(socket, "call_service", service=service, id=name, **given)
    while True:
        answer = hear(socket)
        if answer.get("id") == name:
            return answer


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + AT_MOST
    while not true():
        assert time.monotonic() < end, "did not happen"
        time.sleep(0.005)
