"""The old name of `crowdbot.plugin`, which stays until 1.0."""

from __future__ import annotations

import warnings
from typing import Any

from crowdbot.core.interfaces.numbered_columns import NUMBERED_COLUMNS, numbered_column
from crowdbot.old_names import OldNameWarning, old_name


def __getattr__(name: str) -> Any:
    from crowdbot import plugin
    from crowdbot.core.recording import old_names as old_readers

    if name in NUMBERED_COLUMNS:
        return numbered_column(name)
    if name in old_readers.__all__:
        text = f"{name} is an old name that ends with crowdbot 1.0: use crowdbot.Recording"
        warnings.warn(text, OldNameWarning, stacklevel=2)
        return getattr(old_readers, name)
    return old_name(__name__, plugin, name)
