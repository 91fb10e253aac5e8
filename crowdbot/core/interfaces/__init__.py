"""The old name of `crowdbot.plugin`, which stays until 1.0."""

from __future__ import annotations

import warnings
from typing import Any

from crowdbot.core.interfaces.numbered_columns import NUMBERED_COLUMNS, numbered_column
from crowdbot.old_names import OldNameWarning, old_name

#: Names of `crowdbot.core.recording.old_names`, which imports numpy.
_READERS = ("read_scans", "read_trajectories", "recording_info")


def __getattr__(name: str) -> Any:
    from crowdbot import plugin

    if name in NUMBERED_COLUMNS:
        return numbered_column(name)
    if name in _READERS:
        from crowdbot.core.recording import old_names as old_readers

        text = f"{name} is an old name that ends with crowdbot 1.0: use crowdbot.Recording"
        warnings.warn(text, OldNameWarning, stacklevel=2)
        return getattr(old_readers, name)
    return old_name(__name__, plugin, name)
