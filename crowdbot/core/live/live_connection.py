"""The interface of a live connection: a protocol through which programs listen and command."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from crowdbot.core.live.message import LiveMessage, OfferedTopic


class LiveConnection(Protocol):
    """One live connection; all methods are called by the simulation's thread.

    Failures of a connection never stop the simulation.
    """

    def open(self, offers: Sequence[OfferedTopic]) -> None:
        """Start a run that publishes the given topics."""
        ...

    def wants(self, topic: str) -> bool:
        """Return True if a client listens to a topic."""
        ...

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        """Send messages to the listeners."""
        ...

    def close(self) -> None:
        """Close all connections."""
        ...
