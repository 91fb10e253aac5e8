"""The simulator's end of the connection to a planner process: messages, deadlines, output."""

from __future__ import annotations

import contextlib
import os
import re
import select
import struct
import sys
import time
from collections.abc import Mapping
from typing import Any

import msgpack

from crowdbot.errors import printable

_HEAD = struct.Struct("<I")
#: Largest reply, which is a command and some signals.
LONGEST_ANSWER = 1 << 20
#: Largest amount of a planner's output shown per run, bytes.
LONGEST_OUTPUT = 1 << 20
_TAIL = 16_384
_PEER_CLOSED = getattr(select, "POLLRDHUP", 0)
_CRASH = "Fatal Python error: "
#: A frame of Python's fault handler output, except for code without a file.
_FRAME = re.compile(r"File \"([^<\"][^\"]*)\", line (\d+) in")


class LineClosed(Exception):  # noqa: N818 - an event, reported by the caller
    """The planner's end of the connection is closed."""


class LineTimeout(Exception):  # noqa: N818 - as above
    """There was no reply in time."""


class WrongAnswer(Exception):  # noqa: N818 - as above
    """The received data is not a reply."""


class PlannerLine:
    """Three pipes: messages to a planner, messages from it, and its output.

    Its output goes to ``sys.stderr`` while waiting for a reply, so that a planner that prints more
    than a pipe holds does not block; beyond a limit it is dropped.

    Args:
        write, read, output: descriptors, which this class closes.
        name: name of the planner for messages.
        server: connection to the planner's fork server, which ends the planner when it is killed.
    """

    def __init__(self, write: int, read: int, output: int, name: str, server: int) -> None:
        self._write, self._read, self._output, self._name = write, read, output, name
        for one in (write, read, output):
            os.set_blocking(one, False)
        self._poll = select.poll()
        self._poll.register(read, select.POLLIN)
        self._poll.register(output, select.POLLIN)
        self._poll.register(server, _PEER_CLOSED)
        self._server = server
        self._shown = 0
        self._tail = b""
        self._came = bytearray()

    def ask(self, message: Mapping[str, Any], limit: float) -> dict[str, Any]:
        """Send a message and wait for the reply.

        Args:
            limit: seconds for both.

        Raises:
            LineClosed, LineTimeout, WrongAnswer: there is no valid reply.
        """
        if self._came or self._readable():
            raise WrongAnswer("answered before it was asked")
        until = time.monotonic() + limit
        raw = msgpack.packb(message)
        self._send(memoryview(_HEAD.pack(len(raw)) + raw), until)
        return self._answer(until)

    def tell(self, message: Mapping[str, Any]) -> None:
        """Send a message without a reply, if it can be sent at once."""
        raw = msgpack.packb(message)
        with contextlib.suppress(OSError):
            os.write(self._write, _HEAD.pack(len(raw)) + raw)

    def drain(self) -> None:
        """Show the output so far."""
        before = -1
        while self._output >= 0 and before != self._shown:
            before = self._shown
            if not self._show():
                return

    def close(self) -> None:
        """Close the descriptors."""
        for one in (self._write, self._read, self._output):
            if one >= 0:
                os.close(one)
        self._write = self._read = self._output = -1

    @property
    def last_words(self) -> str:
        """Return the last printed line, or the position of a crash in Python."""
        text = self._tail.decode(errors="replace")
        _, crash, trace = text.rpartition(_CRASH)
        if crash and (frame := _FRAME.search(trace)):
            return f"{frame[1]}:{frame[2]}"
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        return lines[-1][:200] if lines else ""

    def _readable(self) -> bool:
        events = self._poll.poll(0)
        if any(one == self._output for one, _ in events):
            self._show()
        return any(one == self._read and event & select.POLLIN for one, event in events)

    def _send(self, left: memoryview, until: float) -> None:
        """Write all data; a planner that does not read counts as not replying."""
        while left:
            try:
                left = left[os.write(self._write, left) :]
            except BlockingIOError:
                waiting = select.poll()
                waiting.register(self._write, select.POLLOUT)
                waiting.register(self._output if self._output >= 0 else self._read, select.POLLIN)
                waiting.poll(1000.0 * max(0.0, min(0.1, until - time.monotonic())))
                self._show()
                if time.monotonic() >= until:
                    raise LineTimeout from None
            except OSError:
                raise LineClosed from None

    def _answer(self, until: float) -> dict[str, Any]:
        while True:
            events = self._poll.poll(1000.0 * max(0.0, until - time.monotonic()))
            for one, _ in events:
                if one == self._output:
                    self._show()
                elif one == self._read:
                    self._receive()
                elif one == self._server:
                    raise LineClosed
            answer = self._whole()
            if answer is not None:
                return answer
            if time.monotonic() >= until:
                raise LineTimeout

    def _receive(self) -> None:
        try:
            piece = os.read(self._read, 65_536)
        except BlockingIOError:
            return
        except OSError:
            piece = b""
        if not piece:
            raise LineClosed
        self._came += piece

    def _whole(self) -> dict[str, Any] | None:
        """Return the reply if it is complete, else None."""
        if len(self._came) < _HEAD.size:
            return None
        (size,) = _HEAD.unpack_from(self._came)
        if size > LONGEST_ANSWER:
            raise WrongAnswer(f"sent an answer of {size} bytes; {LONGEST_ANSWER} are allowed")
        if len(self._came) < _HEAD.size + size:
            return None
        if len(self._came) > _HEAD.size + size:
            raise WrongAnswer("sent more than one answer")
        raw = bytes(self._came[_HEAD.size :])
        self._came.clear()
        try:
            answer = msgpack.unpackb(raw)
        except Exception as error:  # untrusted data may raise anything
            raise WrongAnswer(f"sent something that is not msgpack: {error}") from None
        if not isinstance(answer, dict):
            raise WrongAnswer(f"sent a {type(answer).__name__}, not a map")
        return answer

    def _show(self) -> bool:
        """Pass on some of the output; return True if there may be more."""
        if self._output < 0:
            return False
        try:
            piece = os.read(self._output, 65_536)
        except BlockingIOError:
            return False
        except OSError:
            piece = b""
        if not piece:
            self._poll.unregister(self._output)
            os.close(self._output)
            self._output = -1
            return False
        self._tail = (self._tail + piece)[-_TAIL:]
        room = LONGEST_OUTPUT - self._shown
        self._shown += len(piece)
        if room > 0:
            _to_stderr(_shown(piece[:room]))
            if len(piece) >= room:
                _to_stderr(f"\n{self._name}: printed more than 1 MB; the rest is left out\n")
        return True


def _shown(piece: bytes) -> str:
    """Return output for the terminal, with control characters escaped."""
    return printable(piece.decode(errors="replace").replace("\r\n", "\n"))


def _to_stderr(text: str) -> None:
    with contextlib.suppress(OSError, ValueError, AttributeError):
        sys.stderr.write(text)
        sys.stderr.flush()
