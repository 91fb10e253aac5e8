"""Data shared by all elements of a Vadere topography: targets by id, and the scene."""

from __future__ import annotations

from dataclasses import dataclass, field

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Data, Draft


@dataclass(slots=True)
class Topography:
    """Targets by id, and the scene to which elements are added."""

    scene: Draft
    report: Report
    targets: dict[int, Data] = field(default_factory=dict)
    absorbing: dict[int, bool] = field(default_factory=dict)


def take_ids(item: Item, report: Report) -> None:
    """Record names and ids as used."""
    report.others(item, "its name, or its look", "id", "visible", "reference")


def way_of(item: Item, into: Topography) -> list[int]:
    """Return the targets of a source or person, in order of visit.

    Raises:
        SpecError: E402, there is no such target.
    """
    listed = item.find("targetIds")
    found = []
    for part in listed.every() if listed else []:
        ident = part.whole()
        if ident not in into.targets:
            known = ", ".join(map(str, sorted(into.targets))) or "none"
            part.refuse(f"no target {ident}; there are: {known}")
        found.append(ident)
    return found
