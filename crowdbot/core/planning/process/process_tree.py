"""End everything that a process started, even if it tried to escape.

Linux: the process is a subreaper, so orphans of its descendants become its children. Where the
kernel limits signals to a domain (Landlock), one call reaches all of it, also what is being forked
at that moment. Uses only the standard library.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import sys
import time
from collections.abc import Container, Iterator
from pathlib import Path
from typing import Any

from crowdbot.core.planning.containment import landlock

_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER = 1, 36
#: Rounds after which processes that fork faster than they are killed are stopped first.
_PATIENT = 5


def adopt_orphans() -> None:
    """Make orphans of this process's descendants its children; on Linux."""
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)


def die_with_parent(parent: int, number: int = signal.SIGKILL) -> None:
    """Let the kernel send a signal to this process when its parent ends; on Linux."""
    _prctl(_PR_SET_PDEATHSIG, number)
    if sys.platform == "linux" and os.getppid() != parent:
        os._exit(1)


def limit_own_signals(version: int) -> bool:
    """Put this process and all it starts in a domain; return True if signals stay in it."""
    from crowdbot.core.planning.containment.system_calls import forbid_new_rights

    forbid_new_rights()
    if version < landlock.ABI_SIGNALS:
        return False
    landlock.deny_signals(version)
    return True


def end_descendants(*, limited: bool) -> int:
    """Kill everything below this process and wait for it; return the number of children reaped.

    Args:
        limited: True if `limit_own_signals` succeeded here, and everything below is in its domain.
    """
    ended, rounds = 0, 0
    while True:
        try:
            pid, _ = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return ended
        if pid:
            ended += 1
            continue
        if not (limited and _kill_domain()):
            _kill_children(stop_first=rounds >= _PATIENT)
        rounds += 1
        time.sleep(0.001)


def end_strays(known: Container[int]) -> None:
    """Kill the children of this process that planners left to it, and wait for them.

    They differ from other children: they may not gain rights (``no_new_privs``), which no process
    can undo.

    Args:
        known: children that are left alone.
    """
    if _is_planners(os.getpid()):  # so are all of its children
        return
    until = time.monotonic() + 5.0
    while time.monotonic() < until:
        strays = [p for p in children(os.getpid()) if p not in known and _is_planners(p)]
        if not strays:
            return
        for pid in strays:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
            with contextlib.suppress(OSError):
                os.waitpid(pid, 0)


def count_descendants(root: int) -> int:
    """Return the number of processes below one."""
    below: dict[int, list[int]] = {}
    for pid, parent, _ in _processes():
        below.setdefault(parent, []).append(pid)
    waiting, descendants = [root], 0
    while waiting:
        inside = below.get(waiting.pop(), [])
        descendants += len(inside)
        waiting += inside
    return descendants


def children(parent: int) -> list[int]:
    """Return the children of a process."""
    return [pid for pid, above, _ in _processes() if above == parent]


def all_tasks() -> int:
    """Return the number of threads of all processes of this machine; 0 if it is unknown."""
    with contextlib.suppress(OSError, ValueError, IndexError):
        return int(Path("/proc/loadavg").read_text().split()[3].partition("/")[2])
    return 0


def _kill_domain() -> bool:
    """Kill all processes of this process's domain but itself, if signals are really limited to it.

    The kernel holds the list of processes meanwhile, so that none can fork away. Process 1 is
    outside of every domain: if even the check of a signal to it is allowed, nothing is killed.
    """
    try:
        os.kill(1, 0)
    except PermissionError:
        with contextlib.suppress(OSError):
            os.kill(-1, signal.SIGKILL)
        return True
    except OSError:
        return False
    return False


def _kill_children(*, stop_first: bool) -> None:
    mine = os.getpid()
    for number in (signal.SIGSTOP, signal.SIGKILL) if stop_first else (signal.SIGKILL,):
        for pid, parent, state in _processes():
            if parent == mine and state != "Z":
                with contextlib.suppress(OSError):
                    os.kill(pid, number)


def _processes() -> Iterator[tuple[int, int, str]]:
    """Yield number, parent and state of all processes."""
    for entry in os.scandir("/proc"):
        if entry.name.isdecimal():
            try:
                stat = Path(entry.path, "stat").read_text(errors="replace")
            except OSError:
                continue
            state, parent = stat.rpartition(")")[2].split()[:2]
            yield int(entry.name), int(parent), state


def _is_planners(pid: int) -> bool:
    try:
        return "\nNoNewPrivs:\t1\n" in Path(f"/proc/{pid}/status").read_text(errors="replace")
    except OSError:
        return False


def _prctl(option: int, value: int) -> None:
    if sys.platform == "linux":
        libc: Any = ctypes.CDLL(None)
        libc.prctl(option, value, 0, 0, 0)
