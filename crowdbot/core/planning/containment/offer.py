"""Containment that this kernel supports, and the request with which a process contains itself."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Final, Literal

from crowdbot.core.planning.containment import landlock, system_calls
from crowdbot.core.planning.containment.libraries import Readable, python_libraries
from crowdbot.core.support.compile_cache import used_folder

Aspect = Literal["files", "network", "signals", "processes"]
#: What a planner that is fully contained cannot reach.
ALL: Final[tuple[Aspect, ...]] = ("files", "network", "signals", "processes")


@dataclass(frozen=True, slots=True)
class Offer:
    """The kernel's means of containment.

    Attributes:
        landlock: version of Landlock's interface; 0: none.
        filter: True if system calls can be filtered.
    """

    landlock: int
    filter: bool

    @property
    def contained(self) -> tuple[Aspect, ...]:
        """Return which accesses the kernel can deny planners.

        Files need Landlock and the filter: Landlock does not restrict modes and owners of files.
        Signals need Landlock, or the filter, which then denies signals to a planner's own children,
        too.
        """
        files: tuple[Aspect, ...] = ("files",) if self.landlock and self.filter else ()
        signals = self.filter or self.landlock >= landlock.ABI_SIGNALS
        others: tuple[Aspect, ...] = ("network", "processes") if self.filter else ()
        found = {*files, *others, *(("signals",) if signals else ())}
        return tuple(aspect for aspect in ALL if aspect in found)

    @property
    def missing(self) -> str:
        """Return which accesses cannot be denied, and why; empty if all can."""
        missing = [aspect for aspect in ALL if aspect not in self.contained]
        if not missing:
            return ""
        lacks = [
            *([] if self.landlock else ["no Landlock (Linux 5.13 or later)"]),
            *([] if self.filter else ["no filter of system calls"]),
        ]
        return f"{', '.join(missing)}: this system has {' and '.join(lacks)}"


@cache
def kernel_offer() -> Offer:
    """Return what this kernel supports; a variable can lower it, to imitate an older kernel.

    ``CROWDBOT_LANDLOCK`` is the newest version of Landlock to use; 0 uses neither Landlock nor the
    filter.
    """
    if sys.platform != "linux":
        return Offer(0, filter=False)
    newest = os.environ.get("CROWDBOT_LANDLOCK", "")
    limit = int(newest) if newest.isdecimal() else sys.maxsize
    return Offer(min(landlock.abi(), limit), filter=limit > 0 and system_calls.has_filter())


@dataclass(frozen=True, slots=True, kw_only=True)
class Needs:
    """Files and network access that a planner needs.

    Attributes:
        files: files and folders that it reads.
        folders: folders whose names it may list, such as the one of its file.
        network: True if its document asks for the network.
        chosen: those files that it names itself, as its data or libraries.
    """

    files: Sequence[str] = ()
    folders: Sequence[str] = field(default=())
    network: bool = False
    chosen: Sequence[str] = ()

    def beyond(self, folder: Path) -> str:
        """Return which needs exceed the files of a folder; empty if none does."""
        if self.network:
            return "asks for the network"
        inside = folder.resolve()
        for one in self.chosen:
            if not Path(one).resolve().is_relative_to(inside):
                return f"declares '{one}', which is not one of its own files"
        return ""


def contained_request(needs: Needs) -> dict[str, Any]:
    """Return the argument of `enforce` for a planner."""
    offer, libraries = kernel_offer(), python_libraries(tuple(sys.path))
    readable = Readable(tuple(needs.files), tuple(needs.folders))
    return {
        "landlock": offer.landlock,
        "filter": offer.filter,
        "network": needs.network,
        "read": [*libraries.files, str(used_folder()), *readable.files],
        "list": [*libraries.folders, *readable.folders],
    }
