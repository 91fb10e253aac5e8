"""Writes the realism of the responses to a robot that come with crowdbot, for the head of reports.

python scripts/write_known_responses.py
"""

from __future__ import annotations

import json

from crowdbot.core.realism.near_robots import known
from crowdbot.core.realism.near_robots.measure import measure
from crowdbot.core.realism.near_robots.reference import shipped
from crowdbot.core.realism.near_robots.responses import KINDS, open_responding, response_of_crowd
from crowdbot.core.registry.registry import discover
from crowdbot.core.support.atomic_write import atomic_write

#: Draws, as of ``crowdbot realism --robot``.
SEEDS = (1, 2)


def main() -> None:
    """Measure each kind of response, and write the numbers."""
    registry, rows = discover(allow=()), {}
    for kind in KINDS:
        crowd = open_responding(kind, registry)
        found = measure(kind, response_of_crowd(crowd, registry), shipped(), SEEDS).as_json()
        rows[kind] = {key: found[key] for key in ("index", "score", "ceiling", "floor")}
    atomic_write(known.PATH, json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
