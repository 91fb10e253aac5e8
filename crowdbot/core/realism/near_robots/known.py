"""Stored realism of the kinds of response to robots, for the head of a report."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

PATH = Path(__file__).with_name("known_responses.json")
#: Reaction of people who do not notice the robot.
_IGNORE = "ignore"


@cache
def known() -> Mapping[str, Mapping[str, float]]:
    """Return kind of response -> index, score, ceiling and floor, with its default values."""
    found: Mapping[str, Mapping[str, float]] = json.loads(PATH.read_text(encoding="utf-8"))
    return found


def response_lines(conditions: Iterable[str]) -> list[str]:
    """Return a line per kind of response.

    Args:
        conditions: texts of the condition ``people_and_robot``, which begin with the kind, such as
            ``giving_way, late_fraction 0, yield, velocity visible``.
    """
    words = [[part.strip() for part in text.split(",")] for text in conditions if text]
    kinds: dict[str, list[list[str]]] = {}
    for parts in words:
        kinds.setdefault(parts[0], []).append(parts)
    return [_line(kind, held) for kind, held in kinds.items()]


def _line(kind: str, held: list[list[str]]) -> str:
    row = known().get(kind)
    if row is None:
        return f"{kind}, whose realism was not measured; measure it with crowdbot realism --robot"
    text = (
        f"{kind}, realism {row['score']:.2f} with its usual values "
        f"(real {row['ceiling']:.2f}, people who ignore the robot {row['floor']:.2f})"
    )
    ignoring = sum(_IGNORE in parts for parts in held)
    more = f"; in {ignoring} of {len(held)} runs people ignore the robot" if ignoring else ""
    return text + more
