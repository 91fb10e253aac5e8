"""Writes the statistics of recorded corridors that crowdbot ships, from the recordings.

    python scripts/write_realism_reference.py hermes_train_4hz.npz

The recordings are not part of the repository: their licences are not clear. The file holds one
array (time, person, 2) for each run, in m at 4 Hz, NaN where absent, x across and y along the
corridor. Names of runs say which corridor it was: ``uo-A-B-C`` one direction, B cm wide;
``boa-W-…`` and ``bot-W-…`` counterflow, W cm wide.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from crowdbot.core.realism.bins import DT
from crowdbot.core.realism.reference import SHIPPED, floors_of, reference_of
from crowdbot.core.realism.tracks import CorridorTracks, tracks_of
from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.trajectories.trajectories import Trajectories

TARGET = Path(__file__).resolve().parents[1] / "crowdbot" / "core" / "realism" / SHIPPED
SOURCES = (
    "HERMES corridor experiments, Jülich and Düsseldorf 2009: Keip, Ries, 'Dokumentation von "
    "Versuchen zur Personenstromdynamik', Bergische Universität Wuppertal; pedestrian dynamics "
    "data archive, doi 10.34735/ped; trajectories by way of OpenTraj",
    "one direction: runs uo in corridors of 2.4 and 3 m; counterflow: runs boa and bot, 3 and "
    "3.6 m, without boa-300-frei; the middle 70 % of each run, 2 m to both sides of the middle",
)
#: Widths of the one-way corridors whose whole window is seen, cm.
_WIDE = ("240", "300")


def runs(path: Path) -> Iterator[CorridorTracks]:
    """Tracks of the runs that are compared, x along the corridor."""
    data = np.load(path)
    for name in sorted(data.files):
        words = name.split("-")
        if name.startswith("uo") and words[2] in _WIDE:
            width = float(words[2])
        elif name[:3] in ("boa", "bot") and "frei" not in name:
            width = float(words[1])
        else:
            continue
        at = data[name].astype(np.float64)
        run = Trajectories.from_arrays(
            t=np.arange(len(at)) * DT, agent_x=at[..., 1], agent_y=at[..., 0], agent_radius=0.0,
            agent_mass=75.0,
        )  # fmt: skip
        yield tracks_of(run, name, width=width / 100.0, centre=True)


def main(path: str) -> None:
    """Write the file."""
    reference = reference_of(list(runs(Path(path))), SOURCES, floors_of((1, 2)))
    text = json.dumps(reference.as_json(), separators=(",", ":"), ensure_ascii=False)
    atomic_write(TARGET, text + "\n")
    print(f"{TARGET}: {len(text)} bytes, ceiling {reference.ceiling.score:.3f}, floor "
          f"{reference.floor.score:.3f}")  # fmt: skip


if __name__ == "__main__":
    main(*sys.argv[1:])
