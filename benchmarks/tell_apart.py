"""Does a suite tell blind robots from careful ones, among people whom nobody has seen?

Draws the people of a suite anew, from another seed, runs planners among them and shows how the
four scores separate who sees nothing (``--blind``) from who is careful (``--careful``):

    python benchmarks/tell_apart.py challenge-2026 --seed 731992 --only 'counter-*-n01' \\
        --only 'both-*-n01' --out /tmp/apart
    python benchmarks/tell_apart.py --out /tmp/apart --table

What is complete under ``--out`` is not run again. ``--table`` only reads what is there. A row of
the last table is one pair of planners in one score: the difference of means over scenarios that
both have run, careful less blind, better side positive; its interval of 95 % by resampling
scenarios, and the share of resamples in which it is above 0.
"""

from __future__ import annotations

import argparse
import re
import shutil
from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import crowdbot
from crowdbot.core.scenarios.library import open_document
from crowdbot.dsl.scenario import Scenario
from crowdbot.errors import CrowdbotError

Array = NDArray[np.float64]
BLIND, CAREFUL = ("goal_seek", "wall_hug"), ("dwa", "stop_and_go")
#: Score of a run, its variant, the variant that a rate is over, and whether more is better.
SCORES = (
    ("safe_efficiency", "corrected", "", True),
    ("contacts_at_fault", "corrected", "", False),
    ("contacts_per_km", "corrected", "way", False),
    ("push_work", "rate", "way", False),
    ("intrusion", "rate", "way", False),
)
#: Others that are shown, without a comparison.
SHOWN = (("evasive_acceleration", "corrected"), ("regress", "share"))
METRICS = [*(s[0] for s in SCORES), *(s[0] for s in SHOWN), "arrival", "time_to_goal"]
RESAMPLES = 10_000


def reseeded(spec: str, seed: int, folder: Path) -> Path:
    """A copy of a suite, with all that it extends, in which another seed draws the people."""
    found = open_document(spec, crowdbot.api.registry())
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copytree(found.path.parent / "parts", folder / "parts", dirs_exist_ok=True)
    text, count = re.subn(r"(?m)^(\s+seed:) \d+", rf"\1 {seed}", found.path.read_text())
    assert count == 1, f"{found.path} has {count} lines with a seed"
    copy = folder / f"{found.path.stem}-{seed}.yaml"
    copy.write_text(text)
    return copy
