"""Containment of this process, before any of the planner's code runs.

Uses only the standard library, since the process has imported nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from crowdbot.core.planning.containment import landlock, system_calls
from crowdbot.core.planning.containment.rights import give_up_rights

#: Programs, libraries and their settings. All of it is public on usual systems.
_SYSTEM = (
    "/usr", "/lib", "/lib32", "/lib64", "/libx32", "/bin", "/sbin", "/opt", "/nix/store",
    "/gnu/store", "/snap", "/sys/devices", "/sys/bus", "/sys/class", "/sys/module/nvidia",
    "/proc/cpuinfo", "/proc/meminfo", "/proc/stat", "/proc/version", "/proc/uptime",
    "/proc/loadavg", "/proc/filesystems", "/proc/devices", "/proc/sys/kernel", "/proc/sys/vm",
    "/proc/driver/nvidia",
)  # fmt: skip
_SETTINGS = (
    "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "ld.so.preload", "localtime", "timezone",
    "nsswitch.conf", "passwd", "group", "hosts", "host.conf", "hostname", "resolv.conf", "gai.conf",
    "services", "protocols", "ssl", "pki", "ca-certificates", "alternatives", "fonts",
    "locale.conf", "mime.types", "magic", "os-release", "OpenCL", "vulkan", "glvnd", "libnl",
    "python3",
)  # fmt: skip
_DEVICES = ("null", "zero", "full", "random", "urandom", "nvidia*", "kfd", "dri")


def rules_of(given: Mapping[str, Any]) -> int:
    """Return the descriptor of the rules for files of a planner; -1 if the kernel has none.

    Later processes of the planner can use them too, which saves most of their cost.

    Args:
        given: from `contained_request`.

    Raises:
        OSError: the kernel refuses what it offers.
    """
    version = given["landlock"]
    if given["filter"]:  # made here once, not in each process
        system_calls.filter_program(network=given["network"], signals=_filters_signals(given))
    if not version:
        return -1
    return landlock.make_rules(version, _allowed(given), network=given["network"])


def enforce(given: Mapping[str, Any], rules: int, scratch: str) -> None:
    """Contain this process and all that it starts, as far as the kernel can.

    Args:
        given: from `contained_request`.
        rules: from `rules_of`, closed here.
        scratch: the only folder that it may write to; it is deleted after the run.

    Raises:
        OSError: the kernel refuses what it offers.
    """
    give_up_rights()
    system_calls.forbid_new_rights()
    version, network = given["landlock"], given["network"]
    if version:
        landlock.allow(rules, "/proc/self", landlock.READ)
        landlock.allow(rules, scratch, landlock.EVERYTHING & landlock.known_rights(version))
        landlock.restrict(rules)
    if given["filter"]:
        system_calls.deny_system_calls(network=network, signals=_filters_signals(given))


def _filters_signals(given: Mapping[str, Any]) -> bool:
    return bool(given["landlock"] < landlock.ABI_SIGNALS)


def _allowed(given: Mapping[str, Any]) -> Iterator[tuple[str, int]]:
    """Yield paths and the rights to them."""
    for path in _SYSTEM:
        yield path, landlock.READ
    for name in _SETTINGS:
        yield f"/etc/{name}", landlock.READ
    for name in _DEVICES:
        for device in Path("/dev").glob(name):
            yield str(device), landlock.DEVICE | landlock.READ_DIR
    for path in given["read"]:
        yield path, landlock.READ
    for path in given["list"]:
        yield path, landlock.READ_DIR
