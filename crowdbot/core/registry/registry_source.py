"""The arguments with which a registry was discovered, from which another process finds it again."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from pathlib import Path

#: Paths of plugins that are not installed, the allow-list, True if entry points are read.
Whereabouts = tuple[tuple[str, ...], tuple[str, ...] | None, bool]


@dataclass(frozen=True, slots=True)
class RegistrySource:
    """The arguments of `discover`."""

    extra: tuple[Path, ...]
    allow: tuple[str, ...] | None
    entry_points: bool


def whereabouts(source: RegistrySource | None) -> Whereabouts:
    """Return the arguments with which another process can discover the same registry.

    Raises:
        PicklingError: it was put together by hand.
    """
    if source is None:
        raise pickle.PicklingError(
            "components of plugins that were not discovered cannot be found by another process"
        )
    return tuple(map(str, source.extra)), source.allow, source.entry_points
