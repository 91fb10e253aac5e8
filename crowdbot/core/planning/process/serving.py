"""The planner's end of the connection: decode messages and reply.

docs/reference/planner_messages.md describes the messages. Used by children of our fork server, with
crowdbot's own classes, and by `foreign_main`, with small ones. It uses only the standard library
and supports Python 3.8, for foreign Pythons.
"""

from __future__ import annotations

import mmap
import os
import struct
from types import MappingProxyType
from typing import Any, Callable  # noqa: UP035 - Python 3.8

PROTOCOL = 1
#: Descriptors of a planner process: messages in, messages out, and shared memory.
READ, WRITE, MEMORY = 3, 4, 5
_HEAD = struct.Struct("<I")
_LONGEST = 1 << 30


class Line:
    """Messages as msgpack maps, each preceded by its length: four bytes, little-endian.

    Args:
        pack, unpack: msgpack, from a library or from `small_msgpack`.
    """

    def __init__(
        self, pack: Callable[[Any], bytes], unpack: Callable[[bytes], Any],
        read: int = READ, write: int = WRITE,
    ) -> None:  # fmt: skip
        self._pack, self._unpack = pack, unpack
        self._read, self._write = read, write

    def receive(self) -> dict[str, Any] | None:
        """Return the next message; None if the other end is closed."""
        head = self._bytes(_HEAD.size)
        if head is None:
            return None
        (size,) = _HEAD.unpack(head)
        if size > _LONGEST:
            raise ValueError(f"a message is too large: {size} bytes")
        raw = self._bytes(size)
        if raw is None:
            return None
        message: dict[str, Any] = self._unpack(raw)
        return message

    def send(self, message: dict[str, Any]) -> None:
        """Send a reply."""
        raw = self._pack(message)
        left = memoryview(_HEAD.pack(len(raw)) + raw)
        while left:
            left = left[os.write(self._write, left) :]

    def _bytes(self, count: int) -> bytes | None:
        """Return this many bytes; None if the other end closes before."""
        found = os.read(self._read, count)
        if len(found) == count:
            return found
        pieces, missing = [found], count - len(found)
        while missing and pieces[-1]:
            pieces.append(os.read(self._read, min(missing, 1 << 20)))
            missing -= len(pieces[-1])
        return None if missing else b"".join(pieces)


def serve(line: Line, side: Any) -> None:
    """Reply to messages until the other end finishes.

    Args:
        line: the connection to the simulator.
        side: ``hello``, ``reset`` and ``observe`` take a message and return the reply; ``error``
            converts an exception to a reply.
    """
    handlers = {"hello": side.hello, "reset": side.reset, "observe": side.observe}
    while True:
        message = line.receive()
        if message is None or message.get("type") == "close":
            return
        try:
            answer = handlers[message["type"]](message)
        except BaseException as error:
            answer = side.error(error)
        line.send({"step": message.get("step", 0), **answer})


def described(kind: Any) -> dict[str, Any]:
    """Return a class's own description."""
    needs, data = getattr(kind, "needs", None), getattr(kind, "data", ())
    return {
        "needs": None if needs is None else [str(n) for n in needs],
        "privileged": getattr(kind, "privileged", False) is True,
        "role": str(getattr(kind, "role", "candidate")),
        "data": [data] if isinstance(data, str) else [str(n) for n in data],
    }


class Decoder:
    """Converts messages to the arguments of `reset` and `step`.

    Args:
        types: module with ``Task``, ``Pose``, ``RobotBody``, ``RobotLimits``, ``SensorInfo``,
            ``Pinhole``, ``Reading``, ``Observation`` and ``Truth``.
        array: builds an array from its type (as numpy writes it), shape and bytes.
    """

    def __init__(self, types: Any, array: Callable[[str, list[int], bytes], Any]) -> None:
        self._types, self._array = types, array
        self._memory: mmap.mmap | None = None

    def open_memory(self, size: int) -> None:
        """Open the shared memory for scans and images."""
        if size:
            self._memory = mmap.mmap(MEMORY, size, access=mmap.ACCESS_READ)

    def array(self, sent: dict[str, Any] | None) -> Any:
        """Return an array from the message or from shared memory."""
        if sent is None:
            return None
        raw = sent.get("data")
        if raw is None:
            assert self._memory is not None
            raw = self._memory[sent["offset"] : sent["offset"] + sent["bytes"]]
        return self._array(sent["dtype"], sent["shape"], raw)

    def task(self, sent: dict[str, Any]) -> Any:
        """Return start, goal, time limit, and the robot."""
        return self._types.Task(
            start=self._types.Pose(*sent["start"]),
            goal=tuple(sent["goal"]),
            goal_zone=self.array(sent["goal_zone"]),
            time_limit=sent["time_limit"],
            robot=self._body(sent.get("robot")),
            person=self._made("PersonTask", sent.get("person")),
        )

    def _made(self, name: str, sent: dict[str, Any] | None) -> Any:
        return None if sent is None else getattr(self._types, name)(**sent)

    def _body(self, sent: dict[str, Any] | None) -> Any:
        if sent is None:
            return None
        return self._types.RobotBody(**{**sent, "footprint": self.array(sent["footprint"])})

    def limits(self, sent: dict[str, Any]) -> Any:
        """Return the box of velocities and slew limits."""
        return self._types.RobotLimits(**sent)

    def sensors(self, sent: dict[str, Any]) -> Any:
        """Return each sensor's description by name."""
        return MappingProxyType({name: self._sensor(info) for name, info in sent.items()})

    def _sensor(self, sent: dict[str, Any]) -> Any:
        camera = sent["camera"]
        made = {
            "mount": tuple(sent["mount"]),
            "tilt": tuple(sent["tilt"]),
            "shape": tuple(sent["shape"]),
            "angles": self.array(sent["angles"]),
            "camera": None if camera is None else self._types.Pinhole(**camera),
        }
        return self._types.SensorInfo(**{**sent, **made})

    def observation(
        self,
        sent: dict[str, Any],
        log: Callable[[str, float], None],
        draw: Callable[..., None],
    ) -> Any:
        """Return the planner's input in one step."""
        return self._types.Observation(
            t=sent["t"],
            pose=self._types.Pose(*sent["pose"]),
            twist=tuple(sent["twist"]),
            vy=sent["vy"],
            goal=tuple(sent["goal"]),
            goal_zone=self.array(sent["goal_zone"]),
            readings=MappingProxyType({n: self._reading(r) for n, r in sent["readings"].items()}),
            log=log,
            truth=self._truth(sent.get("truth")),
            draw=draw,
            person=self._made("PersonEstimate", sent.get("person")),
        )

    def _reading(self, sent: dict[str, Any]) -> Any:
        return self._types.Reading(
            sent["stamp"], self.array(sent["values"]), self.array(sent.get("colour"))
        )

    def _truth(self, sent: dict[str, Any] | None) -> Any:
        if sent is None:
            return None
        people = {n: self.array(a) for n, a in sent.items() if n.startswith("people")}
        return self._types.Truth(
            pose=self._types.Pose(*sent["pose"]), velocity=tuple(sent["velocity"]), **people
        )


def numpy_array(dtype: str, shape: list[int], raw: bytes) -> Any:
    """Return a read-only array on top of the bytes."""
    import numpy as np

    return np.frombuffer(raw, dtype=dtype).reshape(shape)


def tuple_array(dtype: str, shape: list[int], raw: bytes) -> Any:
    """Return nested tuples of numbers, without numpy."""
    form = {"<f8": "d", "<f4": "f", "|u1": "B", "<i8": "q"}[dtype]
    numbers: Any = struct.unpack(f"<{len(raw) // struct.calcsize(form)}{form}", raw)
    for length in reversed(shape[1:]):
        numbers = tuple(numbers[k : k + length] for k in range(0, len(numbers), max(length, 1)))
    return numbers
