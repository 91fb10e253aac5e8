"""A message of a live run, serialised once and sent in each listener's format."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from crowdbot.core.recording import messages as ros


@dataclass(frozen=True, slots=True)
class OfferedTopic:
    """A topic that a live run publishes; ``latched``: late subscribers get the last message."""

    topic: str
    msgtype: str
    latched: bool = False


@dataclass(frozen=True)
class LiveMessage:
    """A message on a topic of a live run, serialised.

    Attributes:
        msgtype: ``package/msg/Name``.
        ns: simulated time, ns.
        data: the message as CDR.
    """

    topic: str
    msgtype: str
    ns: int
    data: bytes
    latched: bool = False

    @cached_property
    def fields(self) -> Any:
        """Return the message as an object, decoded from its bytes."""
        return ros.from_cdr(self.data, self.msgtype)


def live_message(topic: str, ns: int, message: Any, *, latched: bool = False) -> LiveMessage:
    """Return a message object as a `LiveMessage`."""
    return LiveMessage(topic, message.__msgtype__, ns, ros.to_cdr(message), latched)
