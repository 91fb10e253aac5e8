"""The contract of a door: a protocol through which programs outside listen and command."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from crowdbot.core.live.message import LiveMessage, Offer


class Door(Protocol):
    """One way in and out; all methods are called by the thread of the simulation.

    What fails behind a door never stops the simulation.
    """

    def open(self, offers: Sequence[Offer]) -> None:
        """A run begins that offers these topics."""
        ...

    def wants(self, topic: str) -> bool:
        """Whether somebody listens to a topic."""
        ...

    def publish(self, messages: Sequence[LiveMessage]) -> None:
        """Tell those who listen."""
        ...

    def close(self) -> None:
        """End all connections."""
        ...
