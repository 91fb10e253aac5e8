"""Draws docs/images/worlds: the example scenario of each world from above.

Example: .venv/bin/python scripts/write_world_pictures.py
"""

from __future__ import annotations

from pathlib import Path

from crowdbot.cli import main

ROOT = Path(__file__).parent.parent
EXAMPLES, FOLDER = ROOT / "scenario_specs" / "examples", ROOT / "docs" / "images" / "worlds"


def draw() -> list[Path]:
    """Write all pictures; returns where."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    found = []
    for spec in sorted(EXAMPLES.glob("world_*.yaml")):
        picture = FOLDER / f"{spec.stem}.svg"
        if main(["view", str(spec), "--no-plugins", "--out", str(picture)]) != 0:
            raise SystemExit(1)
        found.append(picture)
    return found


if __name__ == "__main__":
    draw()
