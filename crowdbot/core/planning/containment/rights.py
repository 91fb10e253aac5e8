"""Give up the rights of a process of root, except those to read files of others.

Linux lets a process of the same user open another's ``/proc/PID/mem``, or trace it, unless that
process forbids it; root always may, and has to drop the capability. See ptrace(2), section "Ptrace
access mode checking", and capabilities(7). Uses only the standard library.
"""

from __future__ import annotations

import ctypes
import sys
from typing import Any

_PR_SET_DUMPABLE, _PR_CAPBSET_DROP, _PR_CAP_AMBIENT, _PR_CAP_AMBIENT_CLEAR_ALL = 4, 24, 47, 4
_VERSION_3 = 0x20080522
#: CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH: root in a container reads files of other users.
_KEPT = (1, 2)
_CAPABILITIES = 64


class _Header(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("pid", ctypes.c_int))


class _Sets(ctypes.Structure):
    _fields_ = tuple((name, ctypes.c_uint32) for name in ("effective", "permitted", "inheritable"))


def set_inspectable(may: bool) -> None:
    """Allow or forbid other processes of this user to access this one's memory; on Linux."""
    if sys.platform == "linux":
        libc: Any = ctypes.CDLL(None)
        libc.prctl(_PR_SET_DUMPABLE, int(may), 0, 0, 0)


def give_up_rights() -> None:
    """Give up all capabilities but two, for this process and its children, even as root; on Linux.

    An unprivileged user has no capability that cannot be dropped.
    """
    libc: Any = ctypes.CDLL(None)
    for capability in range(_CAPABILITIES):
        if capability not in _KEPT and libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0) != 0:
            break  # beyond the last one, or not root
    libc.prctl(_PR_CAP_AMBIENT, _PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0)
    header, sets = _Header(_VERSION_3, 0), (_Sets * 2)()
    if libc.capget(ctypes.byref(header), sets) != 0:
        return
    kept = sum(1 << capability for capability in _KEPT)
    for half, mask in zip(sets, (kept, 0), strict=True):
        for name in ("effective", "permitted", "inheritable"):
            setattr(half, name, getattr(half, name) & mask)
    libc.capset(ctypes.byref(header), sets)
