"""Clients that do what they should not: garbage, and thousands that come and go; memory after each.

    .venv/bin/python benchmarks/live_clients.py [--frames 10000] [--connects 2000] [--seed 20]

A rosbridge server without a simulation behind it gets frames of garbage (bytes, halves of messages,
wrong fields, deep nesting) from clients that are replaced every thousand frames, and then
connections that subscribe, advertise, and vanish: every other one without a word. Somebody else
drives meanwhile; each of its commands has to arrive. Prints memory, threads, tasks and open files,
and ends with 1 if the second half took more than 5 % more memory, or if something was left.
"""

from __future__ import annotations

import argparse
import json
import logging
import random
import socket as sockets
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import cbor2
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from crowdbot.core.live.message import OfferedTopic, live_message
from crowdbot.core.live.rosbridge.server import Address, RosbridgeServer
from crowdbot.core.live.services import services
from crowdbot.core.live.session import LiveSession
from crowdbot.core.recording import messages as ros

_BOUND = 0.05
_OPS = ("subscribe", "publish", "advertise", "fragment", "call_service", "unsubscribe", "status",
        "set_level", "auth", "png", "", "unadvertise")  # fmt: skip
_FIELDS = ("topic", "id", "msg", "type", "service", "args", "data", "num", "total",
           "throttle_rate", "queue_length", "fragment_size", "compression")  # fmt: skip
_VALUES: tuple[Any, ...] = (
    None, True, -1, 3, 1e308, "x", "/clock", "/rosapi/topics", [], {}, [[]], {"x": 1}, "9" * 50,
    2**80, {"linear": 3}, {"twist": []}, {"linear": {"x": "1"}},
)  # fmt: skip


class Look(NamedTuple):
    """Of this process: memory (B), threads, open files; tasks of the server."""

    memory: int
    threads: int
    files: int
    clients: int


def main() -> int:
    """Both parts, one after the other."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--frames", type=int, default=10_000)
    parser.add_argument("--connects", type=int, default=2_000)
    parser.add_argument("--seed", type=int, default=20)
    chosen = parser.parse_args()
    session = LiveSession()
    server = RosbridgeServer(session, Address(port=0), services(session))
    logging.getLogger("websockets").setLevel(logging.CRITICAL)  # of clients that hang up
    server.open([OfferedTopic("/clock", "rosgraph_msgs/msg/Clock")])
    rng = random.Random(chosen.seed)
    grew = False
    with connect(_uri(server), compression=None) as driver:
        driver.send(json.dumps({"op": "advertise", "topic": "/cmd_vel"}))
        steps = _Steps(server, session, driver)
        send, visit = partial(_garbage, server, rng), partial(_come_and_go, server)
        grew |= _watched("frames", chosen.frames, send, server, steps)
        grew |= _watched("connections", chosen.connects, visit, server, steps)
    server.close()
    print(f"{steps.taken} steps meanwhile, each answered; the longest took {steps.longest:.2f} s")
    return int(grew)


def _uri(server: RosbridgeServer) -> str:
    return f"ws://127.0.0.1:{server.port}"


class _Steps:
    """Steps of lockstep that have to go on whatever others do."""

    def __init__(
        self, server: RosbridgeServer, session: LiveSession, driver: ClientConnection
    ) -> None:
        self._server, self._session, self._driver = server, session, driver
        self.taken, self.longest = 0, 0.0

    def take(self) -> None:
        ns, begin = self.taken * 10**8, time.monotonic()
        self._session.ask(ns)
        self._server.publish([live_message("/clock", ns, ros.clock(ns))])
        twist = {"linear": {"x": 1e-3 * self.taken}}
        self._driver.send(json.dumps({"op": "publish", "topic": "/cmd_vel", "msg": twist}))
        answer = self._session.answer(60.0, lambda: None)
        if answer is None or answer.v != twist["linear"]["x"]:
            raise SystemExit(f"step {self.taken} got {answer}")
        self.taken += 1
        self.longest = max(self.longest, time.monotonic() - begin)


def _watched(
    what: str, count: int, act: Callable[[int], None], server: RosbridgeServer, steps: _Steps
) -> bool:
    """Do a tenth at a time; whether the second half took memory, or something was left."""
    seen = []
    for k in range(10):
        act(count // 10)
        steps.take()
        end = time.monotonic() + 30.0
        while _look(server).clients > 1 and time.monotonic() < end:
            time.sleep(0.01)
        seen.append(_look(server))
        now = seen[-1]
        print(
            f"{(k + 1) * count // 10:7} {what:12} {now.memory / 1e6:7.1f} MB {now.threads:3} "
            f"threads {now.files:3} files {now.clients:3} clients"
        )
    half, last = seen[4], seen[-1]
    grew = last.memory > (1.0 + _BOUND) * half.memory
    left = last.clients > 1 or last.files > half.files + 2 or last.threads > half.threads + 1
    return grew or left


def _look(server: RosbridgeServer) -> Look:
    status = Path("/proc/self/statm").read_text().split()
    files = sum(1 for _ in Path("/proc/self/fd").iterdir())
    return Look(int(status[1]) * 4096, threading.active_count(), files, len(server._connections))


def _garbage(server: RosbridgeServer, rng: random.Random, count: int) -> None:
    with connect(_uri(server), compression=None, close_timeout=1.0) as bad:
        bad.send(json.dumps({"op": "set_level", "level": "none"}))
        with suppress(ConnectionClosed):
            for _ in range(count):
                bad.send(_frame(rng))
            bad.send(json.dumps({"op": "call_service", "service": "/rosapi/nodes", "id": "last"}))
            while '"last"' not in str(bad.recv(timeout=60.0)):
                pass


def _frame(rng: random.Random) -> str | bytes:
    message = {"op": rng.choice(_OPS), **{f: rng.choice(_VALUES) for f in rng.sample(_FIELDS, 4)}}
    text = json.dumps(message)
    kind = rng.randrange(6)
    if kind == 0:
        return rng.randbytes(rng.randrange(60))
    if kind == 1:
        return text[: rng.randrange(len(text))]
    if kind == 2:
        return cbor2.dumps(message)[: rng.randrange(1, 80)]
    return "[" * rng.randrange(5000) if kind == 3 else text


def _come_and_go(server: RosbridgeServer, count: int) -> None:
    for k in range(count):
        with connect(_uri(server), compression=None, close_timeout=1.0) as client:
            client.send(json.dumps({"op": "subscribe", "topic": "/clock"}))
            client.send(json.dumps({"op": "advertise", "topic": "/cmd_vel"}))
            if k % 2:
                client.socket.shutdown(sockets.SHUT_RDWR)


if __name__ == "__main__":
    sys.exit(main())
