"""Parameters of path finding."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class WayFinding:
    """Path finding around walls and pillars; see `crowdbot.dsl.scenario.routing`.

    Attributes:
        spread: largest distance from a corner when passing, m.
        patience: time without progress before looking for another path, s.
        detour: largest relative length of the other path.
        key: key of the random distances from corners.
    """

    spread: float = 0.5
    patience: float = 5.0
    detour: float = 1.5
    key: int = 0
