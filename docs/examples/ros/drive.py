"""Drive the robot of `crowdbot serve` by keyboard or joystick.

    python drive.py [--joystick /dev/input/js0] [--v 0.5] [--w 1.0] [--url ws://127.0.0.1:9090]

Keys: w and s faster and slower, a and d turn, space stops, q leaves. A joystick of Linux: its first
two axes. Needs websockets; the keyboard needs a terminal of Unix.
"""

from __future__ import annotations

import argparse
import json
import select
import struct
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO, NamedTuple

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

#: Seconds between two commands.
PERIOD = 0.1
#: Time (ms), value, type and number of an event of a joystick (linux/joystick.h).
EVENT = struct.Struct("<IhBB")
AXIS = 2
_STEP = 0.1


class Stick(NamedTuple):
    """Deflections from -1 to 1: ahead, and to the left."""

    ahead: float = 0.0
    left: float = 0.0


def after_key(stick: Stick, key: str) -> Stick | None:
    """Return the stick after a key; None to leave."""
    ahead, left = stick
    moved = {
        "w": (ahead + _STEP, left),
        "s": (ahead - _STEP, left),
        "a": (ahead, left + _STEP),
        "d": (ahead, left - _STEP),
        " ": (0.0, 0.0),
    }
    if key in ("q", "\x03", ""):
        return None
    return Stick(*(min(1.0, max(-1.0, x)) for x in moved.get(key, stick)))


def after_event(stick: Stick, event: bytes) -> Stick:
    """Return the stick after an event; axis 0 points right, axis 1 back."""
    _, value, kind, number = EVENT.unpack(event)
    if kind & ~0x80 != AXIS or number > 1:  # 0x80 marks the state at the start
        return stick
    moved = -value / 32767.0
    return stick._replace(left=moved) if number == 0 else stick._replace(ahead=moved)


def twist(stick: Stick, v: float, w: float) -> str:
    """Return the message for a deflection, with the largest speeds (m/s, rad/s)."""
    linear = {"x": v * stick.ahead, "y": 0.0, "z": 0.0}
    angular = {"x": 0.0, "y": 0.0, "z": w * stick.left}
    message = {"linear": linear, "angular": angular}
    return json.dumps({"op": "publish", "topic": "/cmd_vel", "msg": message})


def main() -> None:
    """Send a command every 0.1 s until q, or the end of the connection."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--joystick", metavar="DEVICE")
    parser.add_argument("--v", type=float, default=0.5, help="largest speed, m/s")
    parser.add_argument("--w", type=float, default=1.0, help="largest yaw rate, rad/s")
    parser.add_argument("--url", default="ws://127.0.0.1:9090")
    given = parser.parse_args()
    sticks = _joystick(given.joystick) if given.joystick else _keyboard()
    with connect(given.url) as server:
        kind = "geometry_msgs/Twist"
        server.send(json.dumps({"op": "advertise", "topic": "/cmd_vel", "type": kind}))
        try:
            for stick in sticks:
                server.send(twist(stick, given.v, given.w))
        except ConnectionClosed:
            print("the run is over")


def _keyboard() -> Iterator[Stick]:
    stick: Stick | None = Stick()
    with _raw_terminal():
        while stick is not None:
            yield stick
            if select.select([sys.stdin], [], [], PERIOD)[0]:
                stick = after_key(stick, sys.stdin.read(1))


def _joystick(device: str) -> Iterator[Stick]:
    stick = Stick()
    with open(device, "rb", buffering=0) as events:  # noqa: PTH123 - a device, not a file
        while True:
            yield stick
            stick = _after_all(stick, events)


def _after_all(stick: Stick, events: BinaryIO) -> Stick:
    """Return the stick after all events of a period."""
    while select.select([events], [], [], PERIOD)[0]:
        stick = after_event(stick, events.read(EVENT.size))
        if not select.select([events], [], [], 0.0)[0]:
            break
    return stick


@contextmanager
def _raw_terminal() -> Iterator[None]:
    """Read keys without Enter."""
    import termios
    import tty

    before = termios.tcgetattr(sys.stdin)
    try:
        tty.setcbreak(sys.stdin)
        yield
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)


if __name__ == "__main__":
    main()
