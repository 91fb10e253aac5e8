"""Landlock: a process denies files, TCP and signals to itself and all that it starts.

See landlock(7) and the kernel's Documentation/userspace-api/landlock.rst. Needs no privileges. Raw
system calls, since no maintained library offers them (docs/decisions/0032). Uses only the standard
library.
"""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Iterable
from typing import Any

_CREATE, _ADD_RULE, _RESTRICT = 444, 445, 446  # equal on all architectures
_GET_ABI, _PATH_BENEATH = 1, 1
_LIBC: Any = ctypes.CDLL(None, use_errno=True)
#: Version of the interface that can limit signals.
ABI_SIGNALS = 6

EXECUTE, WRITE_FILE, READ_FILE, READ_DIR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
_MAKE_CHAR, _MAKE_BLOCK = 1 << 6, 1 << 11
_TRUNCATE, _IOCTL_DEVICE = 1 << 14, 1 << 15
#: Rights to a file, as opposed to a folder.
_OF_FILES = EXECUTE | WRITE_FILE | READ_FILE | _TRUNCATE | _IOCTL_DEVICE
#: Number of the rights to files that a version knows.
_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}
_NEWEST_RIGHTS = 16
_TCP, _ABI_TCP = 0b11, 4
_ABSTRACT_SOCKETS_AND_SIGNALS = 0b11

READ = EXECUTE | READ_FILE | READ_DIR
DEVICE = READ_FILE | WRITE_FILE | _IOCTL_DEVICE
EVERYTHING = (1 << _NEWEST_RIGHTS) - 1 & ~(_MAKE_CHAR | _MAKE_BLOCK)


class _Ruleset(ctypes.Structure):
    _fields_ = tuple((name, ctypes.c_uint64) for name in ("files", "network", "scopes"))


class _Beneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("rights", ctypes.c_uint64), ("folder", ctypes.c_int32))


def abi() -> int:
    """Return the version of the interface; 0 if this kernel has none."""
    return max(0, int(_LIBC.syscall(_CREATE, None, 0, _GET_ABI)))


def make_rules(version: int, allowed: Iterable[tuple[str, int]], *, network: bool) -> int:
    """Return a set of rules that denies all files but some, TCP, and signals to other processes.

    Args:
        version: from `abi`, at least 1.
        allowed: paths and the rights to them and to everything below; missing ones are skipped.
        network: True to leave TCP allowed.

    Returns:
        Its descriptor, for any number of processes.

    Raises:
        OSError: the kernel refuses.
    """
    tcp = _TCP if version >= _ABI_TCP and not network else 0
    ruleset = _ruleset(version, known_rights(version), tcp)
    for path, rights in allowed:
        allow(ruleset, path, rights & known_rights(version))
    return ruleset


def restrict(ruleset: int) -> None:
    """Apply a set of rules to this process, and to all that it starts, and close it here.

    Raises:
        OSError: the kernel refuses.
    """
    try:
        _checked(_LIBC.syscall(_RESTRICT, ruleset, 0))
    finally:
        os.close(ruleset)


def deny_signals(version: int) -> None:
    """Deny this process signals to processes that it does not start; files stay allowed.

    Args:
        version: from `abi`, at least `ABI_SIGNALS`.

    Raises:
        OSError: the kernel refuses.
    """
    restrict(_ruleset(version, 0, 0))


def _ruleset(version: int, rights: int, tcp: int) -> int:
    """Return the descriptor of an empty set of rules; older versions know fewer fields."""
    signals = _ABSTRACT_SOCKETS_AND_SIGNALS if version >= ABI_SIGNALS else 0
    fields = 3 if signals else 2 if version >= _ABI_TCP else 1
    given = _Ruleset(rights, tcp, signals)
    return _checked(_LIBC.syscall(_CREATE, ctypes.byref(given), 8 * fields, 0))


def known_rights(version: int) -> int:
    """Return the rights to files that a version knows."""
    return int((1 << _RIGHTS.get(version, _NEWEST_RIGHTS)) - 1)


def allow(ruleset: int, path: str, rights: int) -> None:
    """Add a rule: rights to a path and to everything below it, if it is there.

    Raises:
        OSError: the kernel refuses.
    """
    try:
        found = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return  # denied, as everything that is not there
    try:
        if not stat.S_ISDIR(os.fstat(found).st_mode):
            rights &= _OF_FILES
        beneath = _Beneath(rights, found)
        _checked(_LIBC.syscall(_ADD_RULE, ruleset, _PATH_BENEATH, ctypes.byref(beneath), 0))
    finally:
        os.close(found)


def _checked(answer: int) -> int:
    if answer < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"landlock: {os.strerror(number)}")
    return answer
