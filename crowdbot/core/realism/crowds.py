"""The different crowds of a suite, and their stored realism."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

from crowdbot.core.support.text import plural
from crowdbot.dsl.identity.crowd_likeness import fingerprint
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.scenario import Scenario

KNOWN = "known_crowds.json"


def different_crowds(scenarios: Sequence[Scenario]) -> dict[str, Crowd]:
    """Return the different crowds of some scenarios, each by the id of its first scenario."""
    found: dict[str, tuple[str, Crowd]] = {}
    for scenario in scenarios:
        if scenario.crowd is not None:
            found.setdefault(fingerprint(scenario.crowd), (scenario.id, scenario.crowd))
    return dict(found.values())


@cache
def known() -> Mapping[str, Mapping[str, Any]]:
    """Return fingerprint -> stored name, score, index, ceiling and floor of a crowd."""
    text = resources.files(__package__).joinpath(KNOWN).read_text(encoding="utf-8")
    found: Mapping[str, Mapping[str, Any]] = json.loads(text)
    return found


def by_name(name: str) -> Mapping[str, Any] | None:
    """Return the stored realism of a crowd that comes with crowdbot."""
    return next((row for row in known().values() if row["name"] == name), None)


def realism_by_name(name: str) -> float | None:
    """Return the realism index of a crowd that comes with crowdbot; None for others."""
    row = by_name(name)
    return None if row is None else float(row["index"])


def lines_of(crowds: Iterable[tuple[str, str]]) -> list[str]:
    """Return a line per different crowd for a report's head.

    Args:
        crowds: name (if the campaign gave one) and fingerprint of each run's crowd.
    """
    rows: dict[str, Mapping[str, Any] | None] = {}
    for name, like in crowds:
        row = by_name(name) if name else known().get(like)
        rows.setdefault(name or (row["name"] if row else like), row)
    lines = [_line(name, row) for name, row in rows.items() if row is not None]
    missing = [name for name, row in rows.items() if row is None]
    if missing:
        lines.append(
            f"{plural(len(missing), 'crowd')}; how real these people are was not measured "
            "(crowdbot realism SUITE)"
        )
    return lines


def _line(name: str, row: Mapping[str, Any]) -> str:
    return (
        f"{name}, realism {row['score']:.2f} "
        f"(recorded people {row['ceiling']:.2f}, no avoidance {row['floor']:.2f})"
    )
