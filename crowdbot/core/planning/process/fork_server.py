"""The process that forks planner processes and ends their leftovers.

It has imported only what planners need, so a planner starts in milliseconds and sees nothing of
another run. It serves one planner at a time. A guard above it ends all of them when the simulator
closes the connection or dies, or when the server is killed; the server does so if the guard is.

It uses only the standard library until it gets a list of imports.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import json
import math
import os
import pickle
import resource
import select
import signal
import socket
import struct
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from crowdbot.core.planning.containment.disk_use import DiskUse
from crowdbot.core.planning.containment.enforce import enforce, rules_of
from crowdbot.core.planning.containment.rights import set_inspectable
from crowdbot.core.planning.containment.scratch import make_folder, remove_scratch, use_scratch
from crowdbot.core.planning.process.process_tree import (
    adopt_orphans,
    all_tasks,
    count_descendants,
    die_with_parent,
    end_descendants,
    limit_own_signals,
)

#: A planner's file descriptors: messages in, messages out, memory, as in `serving`.
_TARGETS = (3, 4, 5)
_OUTPUT = (1, 2)
_HEAD = struct.Struct("<I")
#: Seconds after SIGABRT for a process to print its position.
_LAST_WORDS = 0.5
#: Most processes of a planner; seconds between looks; threads of all processes by which the
#: machine has to grow before they are counted.
_MOST_PROCESSES, _LOOKS, _GROWTH = 256, 0.1, 256
_MOST_USES = 64
#: Seconds for the server to end by itself.
_GRACE = 1.0
_LARGEST_FILE = 1 << 30
_PEER_CLOSED = 0x2000  # POLLRDHUP


def main(descriptor: int, landlock: int) -> None:
    """Start the server, and guard it until it ends or the connection is closed.

    Args:
        descriptor: the connection.
        landlock: version of Landlock to use; 0: none.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # only the simulator handles Ctrl-C
    adopt_orphans()
    set_inspectable(False)
    die_with_parent(os.getppid(), signal.SIGCONT)  # resume if stopped, to see the closed connection
    line = socket.socket(fileno=descriptor)
    limited = limit_own_signals(landlock)
    guard, folder = os.getpid(), make_folder()
    server = os.fork()
    if server == 0:
        _serve(line, landlock, guard, folder)
    _guard(line, server)
    end_descendants(limited=limited)
    remove_scratch(folder)
    os._exit(0)


def _guard(line: socket.socket, server: int) -> None:
    """Wait for the server to end, at most a grace period after the simulator has ended."""
    closes = select.poll()
    closes.register(line, _PEER_CLOSED | select.POLLHUP)
    until = math.inf
    while not os.waitpid(server, os.WNOHANG)[0] and time.monotonic() < until:
        if until == math.inf and closes.poll(1000.0 * _LOOKS):
            until = time.monotonic() + _GRACE
        elif until < math.inf:
            time.sleep(0.01)


def _serve(line: socket.socket, landlock: int, guard: int, folder: str) -> NoReturn:
    """Serve planners until the connection is closed."""

    def end(*_: object) -> None:
        end_descendants(limited=limited)
        remove_scratch(folder)
        os._exit(0)

    adopt_orphans()
    signal.signal(signal.SIGTERM, end)
    limited = limit_own_signals(landlock)
    die_with_parent(guard, signal.SIGTERM)
    server = ForkServer(line, folder, limited=limited)
    try:
        while server.serve_one():
            pass
    finally:
        server.end_all()
        os._exit(0)


class ForkServer:
    """Starts and ends one planner at a time.

    Args:
        line: connection: requests are length and pickle, with descriptors; replies are one JSON
            document per line.
        folder: folder of the planners' scratch folders.
        limited: True if the kernel limits signals of this process and of planners to these
            processes.
    """

    def __init__(self, line: socket.socket, folder: str, *, limited: bool) -> None:
        self._line, self._folder, self._pid, self._limited = line, folder, 0, limited
        self._status: int | None = None
        self._tasks = 0
        self._disk = DiskUse("")
        self._why = ""
        self._scratch = ""
        self._rules: tuple[Any, int, int] = (None, -1, 0)

    def serve_one(self) -> bool:
        """Handle the next request; return False if there are no more."""
        self._watch()
        head, descriptors, _, _ = socket.recv_fds(self._line, _HEAD.size, len(_TARGETS) + 1)
        raw = b""
        if len(head) == _HEAD.size:
            raw = self._line.recv(_HEAD.unpack(head)[0], socket.MSG_WAITALL)
        if not raw:
            return False
        request = pickle.loads(raw)  # noqa: S301 - only from this process's parent
        try:
            answer = getattr(self, f"_{request['do']}")(request, descriptors)
        except OSError as error:
            where = error.filename or tempfile.tempdir or "its process"
            answer = {"error": f"cannot be started: {where}: {error.strerror or error}"}
        for one in descriptors:
            os.close(one)
        try:
            self._line.sendall(json.dumps(answer).encode() + b"\n")
        except OSError:
            return False
        return True

    def end_all(self) -> int:
        """Kill the planner and everything below this process; return how many others there were."""
        if self._pid:
            with contextlib.suppress(OSError):
                os.killpg(self._pid, signal.SIGKILL)
            self._wait(None)
        left = end_descendants(limited=self._limited)
        if self._scratch:
            remove_scratch(self._scratch)
            if Path(self._scratch).exists():  # its folder is not shared with the next planner
                self._folder = ""
            self._scratch = ""
        return left

    def _watch(self) -> None:
        """Wait for a request; meanwhile end leftovers of a planner that ended or exceeds a limit.

        Children that hold its pipes would keep the simulator waiting.
        """
        comes = select.poll()
        comes.register(self._line, select.POLLIN)
        while self._pid and not self._why and not comes.poll(1000.0 * _LOOKS):
            if self._wait(0.0):
                end_descendants(limited=self._limited)
                return
            self._why = self._excess()
            if self._why:
                end_descendants(limited=self._limited)
                self._status = -signal.SIGKILL

    def _excess(self) -> str:
        """Describe what the planner has too much of; empty if nothing."""
        many = all_tasks() >= self._tasks + _GROWTH
        if many and count_descendants(os.getpid()) > _MOST_PROCESSES:
            return f"it started more than {_MOST_PROCESSES} processes"
        return self._disk.excess()

    def _import(self, request: Mapping[str, Any], descriptors: Sequence[int]) -> dict[str, Any]:
        """Import installed modules for all later planners."""
        del descriptors
        for name in request["modules"]:
            with contextlib.suppress(Exception):
                importlib.import_module(name)
        return {}

    def _start(self, request: Mapping[str, Any], descriptors: Sequence[int]) -> dict[str, Any]:
        """Fork a planner; the descriptors are messages in and out, memory, output."""
        parent = os.getpid()
        self._status, self._why, self._tasks = None, "", all_tasks()
        self._folder = self._folder or make_folder(tempfile.gettempdir())
        self._scratch = make_folder(self._folder)
        self._disk = DiskUse(self._scratch)
        rules = self._rules_of(request["contain"])
        self._pid = os.fork()
        if self._pid == 0:
            _be_planner(request, descriptors, parent, (self._scratch, rules))
        return {"pid": self._pid, "folder": self._folder}

    def _rules_of(self, given: Mapping[str, Any]) -> int:
        """Return the rules for files, made again if the planner or one of its files changed.

        Each process adds rules for its own ``/proc`` and folder, so they are renewed after many
        uses.
        """
        files = [(path, _inode(path)) for path in (*given["read"], *given["list"])]
        key = (given["network"], files)
        known, rules, uses = self._rules
        if known != key or uses >= _MOST_USES:
            if rules >= 0:
                os.close(rules)
            self._rules = (None, -1, 0)
            rules, uses = rules_of(given), 0
        self._rules = (key, rules, uses + 1)
        return rules

    def _end(self, request: Mapping[str, Any], descriptors: Sequence[int]) -> dict[str, Any]:
        """End the planner, after a grace period for it to exit."""
        del descriptors
        pid, gone = self._pid, self._wait(request["grace"])
        if not gone and request.get("ask"):
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGABRT)
            self._wait(_LAST_WORDS)
        status = self._status if gone else None
        left = self.end_all()
        self._pid = 0
        return {"status": status, "left": left, "why": self._why}

    def _wait(self, seconds: float | None) -> bool:
        """Return True if the planner's process ended within this time, or wait forever."""
        until = None if seconds is None else time.monotonic() + seconds
        pause = 0.0005
        while self._pid and self._status is None:
            pid, status = os.waitpid(self._pid, 0 if until is None else os.WNOHANG)
            if pid == self._pid:
                self._status = os.waitstatus_to_exitcode(status)
            elif until is not None and time.monotonic() > until:
                return False
            else:
                self._pause(pause)
                pause = min(2.0 * pause, 0.02)
        return True

    def _pause(self, seconds: float) -> None:
        select.select([], [], [], seconds)


def _inode(path: str) -> int:
    try:
        return os.stat(path).st_ino  # noqa: PTH116 - fast
    except OSError:
        return 0


def _be_planner(
    request: Mapping[str, Any], descriptors: Sequence[int], parent: int, place: tuple[str, int]
) -> NoReturn:
    """Run the planner in the new process: detach from the server, contain and limit itself."""
    code = 70
    try:
        os.setsid()
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        scratch, rules = place
        _be_ended_first()
        enforce(request["contain"], rules, scratch)
        _take_descriptors(descriptors)
        die_with_parent(parent)
        set_inspectable(False)
        use_scratch(scratch)
        if request["folder"]:
            os.chdir(request["folder"])
        _limit(request["memory"])
        for number in (signal.SIGINT, signal.SIGPIPE):
            signal.signal(number, signal.SIG_DFL)
        if command := request.get("command"):
            _execute(command)
        from crowdbot.core.planning.process import own_child

        signal.signal(signal.SIGPIPE, signal.SIG_IGN)
        own_child.main(request["what"])
        code = 0
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        _leave(code)


def _execute(command: Sequence[str]) -> NoReturn:
    os.environ.pop("NUMBA_CACHE_LOCATOR_CLASSES", None)  # crowdbot's, which it may not have
    try:
        os.execvp(command[0], list(command))  # noqa: S606 - the program that the user named
    except OSError as error:
        os.write(2, f"{command[0]}: cannot be started: {error.strerror}\n".encode())
        os._exit(127)


def _leave(code: int) -> NoReturn:
    """Exit without waiting for threads; flush output and close files."""
    import atexit

    with contextlib.suppress(BaseException):
        atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(BaseException):
            stream.flush()
    with contextlib.suppress(BaseException):
        ctypes.CDLL(None).fflush(None)  # output of compiled code
    os._exit(code)


def _take_descriptors(given: Sequence[int]) -> None:
    """Put messages at 3 and 4, memory at 5, output at 1 and 2; close all others."""
    import fcntl

    high = [fcntl.fcntl(one, fcntl.F_DUPFD, 2 * _TARGETS[-1]) for one in given]
    *lines, output = high
    for target, one in zip(_TARGETS, lines, strict=False):
        os.dup2(one, target)
    for target in _OUTPUT:
        os.dup2(output, target)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    most = os.sysconf("SC_OPEN_MAX")
    with contextlib.suppress(OSError):  # the limit may have been lowered since some were opened
        most = max(most, *(int(entry.name) + 1 for entry in os.scandir("/proc/self/fd")))
    os.closerange(_TARGETS[0] + len(lines), most)


def _be_ended_first() -> None:
    """Let the kernel end this process, before all others, when the machine has no memory left."""
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")


def _limit(memory: int | None) -> None:
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    _lower(resource.RLIMIT_FSIZE, _LARGEST_FILE)
    if memory is not None:
        _lower(resource.RLIMIT_AS, memory)


def _lower(kind: int, limit: int) -> None:
    _, hard = resource.getrlimit(kind)
    least = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
    resource.setrlimit(kind, (least, least))
