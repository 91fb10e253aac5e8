"""A seat with a page server, and pages that are plain websocket clients."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from websockets.sync.client import ClientConnection, connect

from crowdbot.core.live.live_robot import LiveRobot
from crowdbot.core.live.person.page_server import PageServer
from crowdbot.core.live.person.seat import Seat
from crowdbot.core.live.session import LiveSession

AT_MOST = 20.0


def seat_of_a_robot() -> Seat:
    return Seat(LiveSession(robots={"": LiveRobot(name="robot")}))


@contextmanager
def paged(page: str = "<p>page") -> Iterator[tuple[PageServer, Seat]]:
    seat = seat_of_a_robot()
    server = PageServer(seat, page)
    try:
        yield server, seat
    finally:
        server.close()


@contextmanager
def opened(server: PageServer, **more: Any) -> Iterator[ClientConnection]:
    uri = f"ws://127.0.0.1:{server.port}/socket?token={server.token}"
    with connect(uri, compression=None, open_timeout=AT_MOST, close_timeout=1.0, **more) as socket:
        yield socket


def say(socket: ClientConnection, op: str, **fields: Any) -> None:
    socket.send(json.dumps({"op": op, **fields}))


def hear(socket: ClientConnection, op: str) -> dict[str, Any]:
    """The next message of a kind."""
    end = time.monotonic() + AT_MOST
    while time.monotonic() < end:
        document = json.loads(socket.recv(timeout=AT_MOST))
        if document["op"] == op:
            return dict(document)
    raise AssertionError(f"no '{op}' came")


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + AT_MOST
    while not true():
        assert time.monotonic() < end, "did not happen"
        time.sleep(0.005)
