"""The publishers of one topic over zenoh; the first one that publishes counts until it leaves."""

from __future__ import annotations

from typing import Any

from crowdbot.core.live.ros2_keys import gid_of, read_attachment


class ZenohPublishers:
    """The publishers of a topic of commands, or of the clock."""

    def __init__(self) -> None:
        self._gids: dict[str, bytes] = {}  # token -> id of the publisher
        self._first: bytes | None = None

    def came(self, token: str) -> None:
        """Register a publisher by its liveliness token."""
        self._gids[token] = gid_of(token)

    def left(self, token: str) -> bool:
        """Forget a publisher; return True if none is left.

        The first publisher counts as gone if none of the remaining ones is known to be it.
        """
        self._gids.pop(token, None)
        if self._first not in self._gids.values():
            self._first = None
        return not self._gids

    def may(self, sample: Any) -> bool:
        """Return True if a message comes from the first publisher.

        ROS nodes attach the publisher's id to each message. Messages without one count as from one
        publisher.
        """
        attached = None if sample.attachment is None else sample.attachment.to_bytes()
        read = None if attached is None else read_attachment(attached)
        gid = b"" if read is None else read[1]
        if self._first is None:
            self._first = gid
        return self._first == gid
