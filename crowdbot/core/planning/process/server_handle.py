"""Fork servers, as used by the simulator: started on demand, reused, ended with it."""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import pickle
import select
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from typing import Any

from crowdbot.core.planning.containment.offer import kernel_offer
from crowdbot.core.planning.containment.rights import set_inspectable
from crowdbot.core.planning.containment.scratch import remove_scratch
from crowdbot.core.planning.process.process_tree import adopt_orphans, end_strays
from crowdbot.core.registry.plugin_path import path_without_plugins
from crowdbot.errors import PlannerError

_HEAD = struct.Struct("<I")
_START = (
    "import sys, json; sys.path[:] = json.loads(sys.argv[1]); "
    "from crowdbot.core.planning.process.fork_server import main; main(*map(int, sys.argv[2:]))"
)
#: Planners use one thread, as in campaigns, unless the user sets a value.
_ONE_THREAD = (
    "NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS",
)  # fmt: skip
#: Seconds for a server to end its planner and itself, and to import modules.
_GOES, _IMPORTS = 30.0, 600.0
#: Modules that every planner in our Python needs.
_OWN = ("crowdbot.core.planning.process.own_child",)


#: Processes of the servers of this process.
_RUNNING: set[int] = set()


class ServerGone(PlannerError):  # noqa: N818 - what happened
    """The fork server no longer replies: it has ended."""


class ServerHandle:
    """One fork server, with at most one planner."""

    def __init__(self) -> None:
        set_inspectable(False)  # planners have this user's rights
        adopt_orphans()
        ours, theirs = socket.socketpair()
        command = [
            sys.executable,
            "-c",
            _START,
            json.dumps(path_without_plugins()),
            str(theirs.fileno()),
            str(kernel_offer().landlock),
        ]
        with theirs:
            self._process = subprocess.Popen(
                command,
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                start_new_session=True,
                env={**dict.fromkeys(_ONE_THREAD, "1"), **os.environ},
            )
        _RUNNING.add(self._process.pid)
        self._line = ours
        self._owner = os.getpid()
        self._imported: set[str] = set()
        self._unanswered = 0
        self._folder, self._planner = "", 0

    def has_imported(self, modules: Sequence[str]) -> None:
        """Make sure that modules are imported before the next planner is forked."""
        new = [m for m in modules if m not in self._imported]
        if new:
            self._imported |= set(new)
            self._send({"do": "import", "modules": new})

    def start(self, request: Mapping[str, Any], descriptors: Sequence[int]) -> int:
        """Fork a planner; return its process number.

        Raises:
            ServerGone: the server was ended.
            PlannerError: the system cannot start a process.
        """
        self._send({"do": "start", **request}, descriptors)
        answer = self._answer(_IMPORTS)
        if "error" in answer:
            raise PlannerError(answer["error"])
        self._folder, self._planner = str(answer["folder"]), int(answer["pid"])
        return self._planner

    def end(self, *, grace: float, ask: bool = False) -> dict[str, Any]:
        """End the planner and everything it left; return how its process ended.

        Args:
            grace: seconds for it to exit by itself.
            ask: then let it print its position before it is killed.

        Raises:
            ServerGone: the server was ended, or does not reply.
        """
        self._send({"do": "end", "grace": grace, "ask": ask})
        with contextlib.suppress(OSError):
            os.killpg(self._process.pid, signal.SIGCONT)  # a planner may have stopped them
        answer = self._answer(grace + _GOES)
        self._planner = 0  # the server has waited for it: the number may be another's
        return answer

    def sweep(self) -> None:
        """Kill the remaining processes of a server that was killed together with its guard."""
        self.close()
        if os.getpid() == self._owner:
            end_strays(_RUNNING)
            remove_scratch(self._folder)

    def close(self) -> None:
        """End the server, and with it everything below it."""
        if os.getpid() == self._owner:
            _RUNNING.discard(self._process.pid)
            self._line.close()
            try:
                self._process.wait(_GOES)
            except subprocess.TimeoutExpired:
                self._kill()
                self._process.wait()

    @property
    def descriptor(self) -> int:
        """Return the descriptor of the connection to the server."""
        return self._line.fileno()

    @property
    def is_alive(self) -> bool:
        """Return True if it runs and was started by this process."""
        return os.getpid() == self._owner and self._process.poll() is None

    def _kill(self) -> None:
        """Kill the planner, then guard and server, which a planner may have stopped.

        The planner goes first: its parent would be this process, which it could stop as well. A
        server that outlives its guard keeps the connection open.
        """
        for group in (self._planner, self._process.pid):
            if group:
                with contextlib.suppress(OSError):
                    os.killpg(group, signal.SIGKILL)

    def _send(self, request: Mapping[str, Any], descriptors: Sequence[int] = ()) -> None:
        raw = pickle.dumps(dict(request))
        try:
            socket.send_fds(self._line, [_HEAD.pack(len(raw))], list(descriptors))
            self._line.sendall(raw)
        except OSError:
            raise ServerGone("the process that starts planners was ended") from None
        self._unanswered += 1

    def _answer(self, limit: float) -> dict[str, Any]:
        """Return the reply to the latest request, skipping earlier unread ones."""
        answer: dict[str, Any] = {}
        until = time.monotonic() + limit
        while self._unanswered:
            answer = json.loads(self._read(until))
            self._unanswered -= 1
        return answer

    def _read(self, until: float) -> bytes:
        raw, comes = b"", select.poll()
        comes.register(self._line, select.POLLIN)
        while not raw.endswith(b"\n"):
            more = b""
            if comes.poll(1000.0 * max(0.0, until - time.monotonic())):
                with contextlib.suppress(OSError):
                    more = self._line.recv(1)
            else:
                self._kill()
            if not more:
                raise ServerGone("the process that starts planners was ended")
            raw += more
        return raw


class ServerPool:
    """Idle fork servers; each planner takes one and returns it."""

    def __init__(self) -> None:
        self._idle: list[ServerHandle] = []
        self._lock = threading.Lock()

    def take(self, *, own: bool) -> ServerHandle:
        """Return a server without a planner.

        Args:
            own: True for a planner in our Python.
        """
        with self._lock:
            self._idle = [s for s in self._idle if s.is_alive]
            server = self._idle.pop() if self._idle else ServerHandle()
        if own:
            server.has_imported(_OWN)
        return server

    def give_back(self, server: ServerHandle) -> None:
        """Return a server whose planner has ended."""
        with self._lock:
            self._idle.append(server)

    def close(self) -> None:
        """End all idle servers."""
        with self._lock:
            idle, self._idle = self._idle, []
        for server in idle:
            server.close()


POOL = ServerPool()
atexit.register(POOL.close)
