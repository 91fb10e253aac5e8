"""Parameters of finding a way."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class WayFinding:
    """People find their way around walls and pillars; see `crowdbot.dsl.scenario.routing`.

    Attributes:
        spread: how far aside of a corner people pass at most, m.
        patience: without headway for so long, they look for another way, s.
        detour: which is at most so many times as long.
        key: of the draws of how far aside each passes.
    """

    spread: float = 0.5
    patience: float = 5.0
    detour: float = 1.5
    key: int = 0
