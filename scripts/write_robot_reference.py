"""Writes the statistics of people near robots that crowdbot ships, from recordings.

    python scripts/write_robot_reference.py navware_1_26.npz citr_half.npz

The recordings are not part of the repository: their licences do not allow it, or are not clear.
For their format see docs/howto/validate_against_your_robot.md.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path

from crowdbot.core.realism.near_robots.encounters import encounters_of
from crowdbot.core.realism.near_robots.recordings import read_clips
from crowdbot.core.realism.near_robots.reference import SHIPPED, reference_of
from crowdbot.core.support.atomic_write import atomic_write

_ROOT = Path(__file__).resolve().parents[1]
TARGET = _ROOT / "crowdbot" / "core" / "realism" / "near_robots" / SHIPPED
SOURCES = (
    "NavWareSet-Quant (2026): 272 drives of HSR (0.3 m/s) and Jackal (1 m/s) among people, "
    "scenes 1 to 26",
    "VCI-CITR: a golf cart among instructed people, every second clip (Yang, Li, Redmill, Özgüner, "
    "Top-view trajectories, IV 2019)",
)


def main(files: Sequence[str]) -> None:
    """Write the file."""
    clips = [clip for file in files for clip in read_clips(Path(file))]
    reference = reference_of(encounters_of(clips), SOURCES, scenes=True)
    text = json.dumps(reference.as_json(), separators=(",", ":"), ensure_ascii=False)
    atomic_write(TARGET, text + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
