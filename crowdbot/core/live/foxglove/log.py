"""The log of Foxglove's server about its clients, bounded and without control characters."""

from __future__ import annotations

import logging

from crowdbot.errors import printable

#: Records that are shown; a client could write without end otherwise. And their length.
_MOST, _LONGEST = 20, 300
_LOGGER = "foxglove.websocket.connected_client"


class _Bounded(logging.Filter):
    """Log filter that limits the number of records, and escapes and shortens their texts."""

    def __init__(self) -> None:
        super().__init__()
        self._count = 0

    def filter(self, record: logging.LogRecord) -> bool:
        """Return True if a record is shown; its text is replaced."""
        self._count += 1
        text = printable(record.getMessage()[:_LONGEST])
        more = "; further messages of this kind are not shown" if self._count == _MOST else ""
        record.msg, record.args = text + more, ()
        return self._count <= _MOST


def bound_log() -> None:
    """Limit the log messages about clients, in this process."""
    logger = logging.getLogger(_LOGGER)
    if not any(isinstance(f, _Bounded) for f in logger.filters):
        logger.addFilter(_Bounded())
