"""What the page shows of one run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.reading.images import ReplayImages
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.replay.other_track import OtherTrack, Seen
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.score import Score


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenery:
    """What stands in the scene, and whom it stops.

    Attributes:
        walls: (S, 4) segments x0, y0, x1, y1, m.
        stops_robot, stops_crowd: (S,) whom each stops.
        pillars: (P, 3) x, y, radius, m.
        blocks: convex outlines (K, 2) of what stops robots as a whole, m.
        steps: the same of what robots touch and people step over, m.
    """

    walls: Array
    stops_robot: NDArray[np.bool_]
    stops_crowd: NDArray[np.bool_]
    pillars: Array = field(default_factory=lambda: np.zeros((0, 3)))
    blocks: tuple[Array, ...] = ()
    steps: tuple[Array, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ShownRun:
    """One run as the page shows it.

    Attributes:
        run: a run without robot or without people is fine.
        title: e.g. the scenario's id and the planner.
        label: what tells the run from those beside it, e.g. the planner; default: the title.
        facts: name -> text; ``Status`` is shown beside the title.
        scans: what lidars, ultrasounds and infrared sensors saw; drawn from the robot's true pose.
        images: what cameras saw.
        scores: shown beside the run; may be empty.
        look: parts of the robot as they are seen from above, the lowest first, in its frame;
            without any it is its outline and an arrow.
        robot: name of the run's robot, where there are others.
        others: the other robots of a fleet.
        scenery: default: the run's walls, which stop everybody.
    """

    run: Trajectories
    title: str
    label: str = ""
    facts: Mapping[str, str] = field(default_factory=dict)
    scans: Sequence[ReplayScan] = ()
    images: Sequence[ReplayImages] = ()
    scores: Sequence[Score] = ()
    look: Sequence[Seen] = ()
    robot: str = "robot"
    others: Sequence[OtherTrack] = ()
    scenery: Scenery | None = None

    @property
    def status(self) -> str:
        """How it ended; empty where nobody said so."""
        return next((v for k, v in self.facts.items() if k.lower() == "status"), "")
