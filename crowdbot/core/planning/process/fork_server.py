"""The process that forks planner processes and ends their leftovers.

It has imported only what planners need, so a planner starts in milliseconds and sees nothing of
another run. It serves one planner at a time. On Linux it is the subreaper: orphaned children of a
planner stay below it, even with a session of their own. It ends, with everything below it, when the
simulator closes the connection or dies.

It uses only the standard library until it gets a list of imports.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import json
import os
import pickle
import resource
import select
import signal
import socket
import struct
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from crowdbot.core.planning.process.inspection import give_up_inspecting, set_inspectable

#: A planner's file descriptors: messages in, messages out, memory, as in `serving`.
_TARGETS = (3, 4, 5)
_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER = 1, 36
_LINUX = sys.platform == "linux"
_OUTPUT = (1, 2)
_HEAD = struct.Struct("<I")
#: Seconds after SIGABRT for a process to print its position.
_LAST_WORDS = 0.5


def main(descriptor: int) -> None:
    """Serve until the connection is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # only the simulator handles Ctrl-C
    if _LINUX:
        _prctl(_PR_SET_CHILD_SUBREAPER, 1)
        _prctl(_PR_SET_PDEATHSIG, signal.SIGCONT)  # resume if stopped, to see the closed connection
        set_inspectable(False)
    line = socket.socket(fileno=descriptor)
    server = ForkServer(line)
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
    """

    def __init__(self, line: socket.socket) -> None:
        self._line, self._pid = line, 0
        self._status: int | None = None

    def serve_one(self) -> bool:
        """Handle the next request; return False if there are no more."""
        head, descriptors, _, _ = socket.recv_fds(self._line, _HEAD.size, len(_TARGETS) + 1)
        raw = b""
        if len(head) == _HEAD.size:
            raw = self._line.recv(_HEAD.unpack(head)[0], socket.MSG_WAITALL)
        if not raw:
            return False
        request = pickle.loads(raw)  # noqa: S301 - only from this process's parent
        answer = getattr(self, f"_{request['do']}")(request, descriptors)
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
        left = 0
        while True:
            try:
                pid, _ = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return left
            if pid == 0:
                left += self._kill_children()
                time.sleep(0.002)

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
        self._status = None
        self._pid = os.fork()
        if self._pid == 0:
            _be_planner(request, descriptors, parent)
        return {"pid": self._pid}

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
        return {"status": status, "left": left}

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

    def _kill_children(self) -> int:
        """Kill all children of this process; their orphans become its children in turn."""
        mine, killed = os.getpid(), 0
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                fields = (folder / "stat").read_text(errors="replace").rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[1]) == mine and fields[0] != "Z":
                with contextlib.suppress(OSError):
                    os.kill(int(folder.name), signal.SIGKILL)
                    killed += 1
        return killed


def _be_planner(request: Mapping[str, Any], descriptors: Sequence[int], parent: int) -> NoReturn:
    """Run the planner in the new process: detach from the server and apply limits."""
    code = 70
    try:
        os.setsid()
        _take_descriptors(descriptors)
        if _LINUX:
            _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() != parent:
                os._exit(1)
            give_up_inspecting()
            set_inspectable(True)
        _limit(request["memory"])
        if request["folder"]:
            os.chdir(request["folder"])
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

    high = [fcntl.fcntl(one, fcntl.F_DUPFD, 64) for one in given]
    *lines, output = high
    for target, one in zip(_TARGETS, lines, strict=False):
        os.dup2(one, target)
    for target in _OUTPUT:
        os.dup2(output, target)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.closerange(_TARGETS[0] + len(lines), os.sysconf("SC_OPEN_MAX"))


def _limit(memory: int | None) -> None:
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if memory is not None:
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        least = memory if hard == resource.RLIM_INFINITY else min(memory, hard)
        resource.setrlimit(resource.RLIMIT_AS, (least, least))


def _prctl(option: int, value: int) -> None:
    libc: Any = ctypes.CDLL(None)
    libc.prctl(option, value, 0, 0, 0)
