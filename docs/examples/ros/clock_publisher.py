"""Publish a clock to `crowdbot serve --clock external`, as the original's clock_publisher.py does.

    python clock_publisher.py SLEEP DELTA [URL]

Every SLEEP seconds of wall time the simulated time moves on by DELTA seconds. Needs websockets.
"""

from __future__ import annotations

import itertools
import json
import sys
import time
from collections.abc import Callable

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

URL = "ws://127.0.0.1:9090"


def clock(ticks: int, delta: float) -> dict[str, object]:
    """Return the message for a number of ticks; times are multiples, so that they do not drift."""
    nanoseconds = round(ticks * delta * 1e9)
    stamp = {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}
    return {"op": "publish", "topic": "/clock", "msg": {"clock": stamp}}


def publish(
    sleep: float, delta: float, url: str = URL, pause: Callable[[float], object] = time.sleep
) -> int:
    """Publish until the server ends the connection; return the number of messages."""
    with connect(url) as server:
        kind = "rosgraph_msgs/Clock"
        server.send(json.dumps({"op": "advertise", "topic": "/clock", "type": kind}))
        for ticks in itertools.count():
            try:
                server.send(json.dumps(clock(ticks, delta)))
            except ConnectionClosed:
                return ticks
            pause(sleep)
    raise AssertionError("unreachable")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    publish(float(sys.argv[1]), float(sys.argv[2]), *sys.argv[3:])
