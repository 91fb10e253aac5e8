"""A process that answers one line of JSON to each line of JSON."""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import subprocess
import time
import weakref
from collections.abc import Mapping, Sequence
from typing import Any

#: Seconds that a process gets to end by itself once its input is closed.
_GRACE = 1.0
#: A longer answer is nonsense, bytes.
_LONGEST = 1 << 20


class ProcessError(RuntimeError):
    """The process died, answered nonsense or did not answer in time."""


class JsonProcess:
    """A child process on two pipes; its stderr is ours.

    It is ended, and waited for, by `close`, when the object is collected, and at exit.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._child = subprocess.Popen(
            list(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0
        )
        self._rest = b""
        self._end = weakref.finalize(self, _end, self._child)

    @property
    def pid(self) -> int:
        """Process id of the child."""
        return self._child.pid

    def ask(self, message: Mapping[str, Any], patience: float) -> dict[str, Any]:
        """Send a message and wait for the answer, at most ``patience`` s.

        Raises:
            ProcessError: there is none, or it is not a JSON object.
        """
        until = time.monotonic() + patience
        assert self._child.stdin is not None
        try:
            self._child.stdin.write(json.dumps(message).encode() + b"\n")
            line = self._line(until)
        except (BrokenPipeError, EOFError):
            raise ProcessError(f"the process ended{self._status()}") from None
        except TimeoutError:
            self.close()
            raise ProcessError(f"the process did not answer within {patience:g} s") from None
        try:
            answer = json.loads(line)
        except ValueError:
            answer = None
        if not isinstance(answer, dict):
            raise ProcessError(f"the process answered {line[:80]!r}, which is not a JSON object")
        return answer

    def close(self) -> None:
        """End the child and wait for it."""
        self._end()

    def _line(self, until: float) -> bytes:
        assert self._child.stdout is not None
        with selectors.DefaultSelector() as selector:
            selector.register(self._child.stdout, selectors.EVENT_READ)
            while b"\n" not in self._rest:
                if not selector.select(max(0.0, until - time.monotonic())):
                    raise TimeoutError
                data = os.read(self._child.stdout.fileno(), 65536)
                if not data or len(self._rest) > _LONGEST:
                    raise EOFError
                self._rest += data
        line, _, self._rest = self._rest.partition(b"\n")
        return line

    def _status(self) -> str:
        with contextlib.suppress(subprocess.TimeoutExpired):
            return f" with status {self._child.wait(_GRACE)}"
        return ""


def _end(child: subprocess.Popen[bytes]) -> None:
    """Close the input, which asks the child to end; then insist."""
    for pipe in (child.stdin, child.stdout):
        with contextlib.suppress(OSError):
            pipe.close()  # type: ignore[union-attr]
    try:
        child.wait(_GRACE)
    except subprocess.TimeoutExpired:
        child.kill()
        child.wait()
