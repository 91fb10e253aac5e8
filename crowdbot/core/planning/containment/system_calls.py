"""A seccomp filter of system calls that Landlock does not deny.

Denied are calls that reach other processes (limits, priorities, memory), sockets, shared memory of
System V, and changes of modes, owners and times of files. A denied call returns EPERM. See
seccomp(2). The filter is a program of about eighty jumps; no maintained library writes it without a
C library of its own (docs/decisions/0032). Uses only the standard library.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import struct
from collections.abc import Sequence
from functools import cache
from typing import Any

_LOAD, _EQUAL, _AT_LEAST, _AND, _RETURN = 0x20, 0x15, 0x35, 0x54, 0x06
_ALLOW = 0x7FFF0000
_DENY, _UNKNOWN = 0x00050000 | errno.EPERM, 0x00050000 | errno.ENOSYS
#: Offsets in what the kernel gives to the filter: number, architecture, arguments.
_NUMBER, _ARCHITECTURE, _ARGUMENTS = 0, 4, 16
_PR_SET_SECCOMP, _PR_GET_SECCOMP, _MODE_FILTER = 22, 21, 2
_PR_SET_NO_NEW_PRIVS = 38

#: Stands for the number of the filtered process; size of an instruction, bytes.
_SELF, _INSTRUCTION = 0x7FFFFFF1, 8
#: Machine -> the kernel's number of the architecture, and the column of `_NUMBERS`.
_MACHINES = {"x86_64": (0xC000003E, 0), "aarch64": (0xC00000B7, 1)}
#: On x86-64, calls with this bit are those of another interface, x32.
_X32 = 0x40000000
#: Name -> number on x86-64 and aarch64; None: there is none.
_NUMBERS: dict[str, tuple[int | None, int | None]] = {
    # memory and limits of others
    "ptrace": (101, 117), "process_vm_readv": (310, 270), "process_vm_writev": (311, 271),
    "kcmp": (312, 272), "pidfd_getfd": (438, 438), "process_madvise": (440, 440),
    "process_mrelease": (448, 448), "move_pages": (279, 239), "migrate_pages": (256, 238),
    "perf_event_open": (298, 241), "bpf": (321, 280), "userfaultfd": (323, 282),
    # what others share with it
    "shmget": (29, 194), "shmat": (30, 196), "shmctl": (31, 195), "semget": (64, 190),
    "semop": (65, 193), "semctl": (66, 191), "semtimedop": (220, 192), "msgget": (68, 186),
    "msgsnd": (69, 189), "msgrcv": (70, 188), "msgctl": (71, 187), "mq_open": (240, 180),
    "mq_unlink": (241, 181), "add_key": (248, 217), "request_key": (249, 218),
    "keyctl": (250, 219),
    # names of files anywhere, as others make them
    "inotify_init": (253, None), "inotify_init1": (294, 26), "fanotify_init": (300, 262),
    # ways around the rules for files and sockets
    "io_uring_setup": (425, 425), "open_by_handle_at": (304, 265), "mount": (165, 40),
    "umount2": (166, 39), "pivot_root": (155, 41), "chroot": (161, 51), "setns": (308, 268),
    "unshare": (272, 97), "open_tree": (428, 428), "move_mount": (429, 429), "fsopen": (430, 430),
    "fsmount": (432, 432), "mount_setattr": (442, 442), "truncate": (76, 45),
    # attributes of files, which Landlock leaves alone
    "chmod": (90, None), "fchmod": (91, 52), "fchmodat": (268, 53), "fchmodat2": (452, 452),
    "chown": (92, None), "fchown": (93, 55), "lchown": (94, None), "fchownat": (260, 54),
    "setxattr": (188, 5), "lsetxattr": (189, 6), "fsetxattr": (190, 7), "setxattrat": (463, 463),
    "removexattr": (197, 14), "lremovexattr": (198, 15), "fremovexattr": (199, 16),
    "removexattrat": (466, 466), "utime": (132, None), "utimes": (235, None),
    "futimesat": (261, None), "utimensat": (280, 88), "file_setattr": (469, 469),
    # with conditions
    "prlimit64": (302, 261), "sched_setparam": (142, 118), "sched_setscheduler": (144, 119),
    "sched_setaffinity": (203, 122), "sched_setattr": (314, 274), "setpriority": (141, 140),
    "ioprio_set": (251, 30), "socket": (41, 198), "socketpair": (53, 199), "clone": (56, 220),
    "clone3": (435, 435), "fcntl": (72, 25), "ioctl": (16, 29), "open": (2, None),
    "openat": (257, 56), "openat2": (437, 437), "kill": (62, 129), "tkill": (200, 130),
    "tgkill": (234, 131), "rt_sigqueueinfo": (129, 138), "rt_tgsigqueueinfo": (297, 240),
    "pidfd_send_signal": (424, 424),
}  # fmt: skip
_CONDITIONAL = "prlimit64"
#: Denied without a condition: all before the first with one.
_ALWAYS = tuple(_NUMBERS)[: tuple(_NUMBERS).index(_CONDITIONAL)]
#: Calls whose first argument is a process; 0 is the caller.
_OF_A_PROCESS = (
    "prlimit64", "sched_setparam", "sched_setscheduler", "sched_setaffinity", "sched_setattr",
)  # fmt: skip
#: Calls whose second argument is a process; the first says that it is one.
_OF_SOME = ("setpriority", "ioprio_set")
_PRIO_PROCESS, _IOPRIO_PROCESS = 0, 1
_SIGNALS = ("kill", "tgkill", "rt_sigqueueinfo", "rt_tgsigqueueinfo")
#: CLONE_NEW...: mounts, cgroup, host name, IPC, user, processes, network, time.
_NEW_SPACES = 0x7E020080
_O_ACCESS, _O_TRUNCATE = 0o3, 0o1000
#: F_SETOWN, F_SETOWN_EX, F_SETLEASE, F_NOTIFY: signals to others, and files that others wait for.
_FCNTL = (8, 15, 1024, 1026)
#: FIOSETOWN, SIOCSPGRP, TIOCSTI, TIOCLINUX.
_IOCTL = (0x8901, 0x8902, 0x5412, 0x541C)
#: Kinds of ioctl that change attributes of files, or make and delete trees of them, without a right
#: to write: ext4 and others, versions, XFS, btrfs. Their calls that read, or that copy into a file
#: that is open for writing: GETFLAGS, FIEMAP, FSGETXATTR, FICLONE, FICLONERANGE.
_OF_FILE_SYSTEMS, _KIND = (0x6600, 0x7600, 0x5800, 0x9400), 0xFF00
_HARMLESS = (0x80086601, 0xC020660B, 0x801C581F, 0x40049409, 0x4020940D)
_LOCAL, _DATAGRAMS = 1, 2  # AF_UNIX; a bit of SOCK_DGRAM and SOCK_RAW, which reach sockets by name
_INTERNET = (2, 10, 16)  # AF_INET, AF_INET6; AF_NETLINK, by which addresses are looked up


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("code", ctypes.c_char_p))


def has_filter() -> bool:
    """Return True if this kernel filters system calls and this machine's numbers are known."""
    libc: Any = ctypes.CDLL(None)
    known = platform.machine() in _MACHINES and struct.calcsize("P") == 8
    return known and libc.prctl(_PR_GET_SECCOMP, 0, 0, 0, 0) >= 0


def forbid_new_rights() -> None:
    """Let no program that this process starts gain rights, for example by a set-user-ID bit."""
    libc: Any = ctypes.CDLL(None)
    libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)


def deny_system_calls(*, network: bool, signals: bool) -> None:
    """Filter the system calls of this process and of all that it starts.

    Args:
        network: True to allow sockets of the internet.
        signals: True to deny signals to other processes, its own children included, for kernels
            whose Landlock cannot tell them apart.

    Raises:
        OSError: the kernel refuses.
    """
    code = filter_program(network=network, signals=signals)
    code = code.replace(struct.pack("=I", _SELF), struct.pack("=I", os.getpid()))
    libc: Any = ctypes.CDLL(None, use_errno=True)
    given = _Program(len(code) // _INSTRUCTION, code)
    if libc.prctl(_PR_SET_SECCOMP, _MODE_FILTER, ctypes.byref(given), 0, 0) != 0:
        number = ctypes.get_errno()
        raise OSError(number, f"seccomp: {os.strerror(number)}")


@cache
def filter_program(*, network: bool, signals: bool) -> bytes:
    """Return the filter's instructions, with `_SELF` for the number of the process."""
    return b"".join(_program(network=network, signals=signals))


def _program(*, network: bool, signals: bool) -> list[bytes]:
    """Return the filter's instructions."""
    architecture, column = _MACHINES[platform.machine()]
    numbers = {name: both[column] for name, both in _NUMBERS.items()}
    me = _SELF

    def only(name: str, checks: Sequence[bytes]) -> list[bytes]:
        """Return filter instructions that check one call's arguments; they end with a return."""
        number = numbers[name]
        return [] if number is None else [_jump(_EQUAL, number, 0, len(checks)), *checks]

    program = [
        _do(_LOAD, _ARCHITECTURE), _jump(_EQUAL, architecture, 1, 0), _do(_RETURN, _DENY), _load(),
        _jump(_AT_LEAST, _X32, 0, 1), _do(_RETURN, _UNKNOWN),
    ]  # fmt: skip
    for name in _ALWAYS:
        program += only(name, [_do(_RETURN, _DENY)])
    for name in _OF_A_PROCESS:
        program += only(name, _one_of(0, (0, me)))
    for name, target in zip(_OF_SOME, (_PRIO_PROCESS, _IOPRIO_PROCESS), strict=True):
        program += only(name, [*_unless(0, target), *_one_of(1, (0, me))])
    for name in _SIGNALS if signals else ():
        program += only(name, _one_of(0, (0, me)))
    for name in ("tkill", "pidfd_send_signal") if signals else ():
        program += only(name, [_do(_RETURN, _DENY)])
    program += only("socket", _one_of(0, _INTERNET if network else ()))
    program += only("socketpair", [*_unless(0, _LOCAL), *_masked(1, _DATAGRAMS, 0)])
    program += only("clone", _masked(0, _NEW_SPACES, 0))
    for name in ("clone3", "openat2"):  # their arguments are out of reach; libraries use others
        program += only(name, [_do(_RETURN, _UNKNOWN)])
    program += only("fcntl", _one_of(1, _FCNTL, _DENY, _ALLOW))
    program += only("ioctl", [*_none_of_kinds(1), *_one_of(1, _IOCTL, _DENY, _ALLOW)])
    for name, place in (("open", 1), ("openat", 2)):  # cutting a file that is opened for reading
        program += only(name, _masked_not(place, _O_ACCESS | _O_TRUNCATE, _O_TRUNCATE))
    return [*program, _do(_RETURN, _ALLOW)]


def _do(code: int, value: int) -> bytes:
    return struct.pack("=HBBI", code, 0, 0, value)


def _jump(code: int, value: int, then: int, other: int) -> bytes:
    return struct.pack("=HBBI", code, then, other, value)


def _load(argument: int | None = None) -> bytes:
    """Load the call's number, or the lower half of an argument."""
    return _do(_LOAD, _NUMBER if argument is None else _ARGUMENTS + 8 * argument)


def _one_of(
    argument: int, values: Sequence[int], then: int = _ALLOW, otherwise: int = _DENY
) -> list[bytes]:
    """Return one answer if an argument has one of the values, and the other one if not."""
    tests = [_jump(_EQUAL, value, len(values) - k, 0) for k, value in enumerate(values)]
    return [_load(argument), *tests, _do(_RETURN, otherwise), _do(_RETURN, then)]


def _unless(argument: int, value: int) -> list[bytes]:
    """Deny the call unless an argument has a value; go on if it has."""
    return [_load(argument), _jump(_EQUAL, value, 1, 0), _do(_RETURN, _DENY)]


def _none_of_kinds(argument: int) -> list[bytes]:
    """Deny calls of some kinds that are not harmless; go on with all others."""
    last = len(_OF_FILE_SYSTEMS) - 1
    kinds = [
        _jump(_EQUAL, value, last - k, int(k == last)) for k, value in enumerate(_OF_FILE_SYSTEMS)
    ]
    denied = [_do(_AND, _KIND), *kinds, _do(_RETURN, _DENY)]
    rest = len(_HARMLESS) - 1 + len(denied)
    harmless = [_jump(_EQUAL, value, rest - k, 0) for k, value in enumerate(_HARMLESS)]
    return [_load(argument), *harmless, *denied]


def _masked(argument: int, mask: int, value: int) -> list[bytes]:
    test = _jump(_EQUAL, value, 1, 0)
    return [_load(argument), _do(_AND, mask), test, _do(_RETURN, _DENY), _do(_RETURN, _ALLOW)]


def _masked_not(argument: int, mask: int, denied: int) -> list[bytes]:
    test = _jump(_EQUAL, denied, 0, 1)
    return [_load(argument), _do(_AND, mask), test, _do(_RETURN, _DENY), _do(_RETURN, _ALLOW)]
