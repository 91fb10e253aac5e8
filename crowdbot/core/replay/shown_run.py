"""The page's data of one run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.recording.reading.images import ReplayImages
from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.replay.other_track import OtherTrack, Seen
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.score import Score


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenery:
    """Obstacles in the scene, and whom each of them stops.

    Attributes:
        walls: (S, 4) segments x0, y0, x1, y1, m.
        stops_robot, stops_crowd: (S,) True for walls that stop robots, or people.
        pillars: (P, 3) x, y, radius, m.
        blocks: convex outlines (K, 2) of solids that stop robots and people, m.
        steps: the same for solids that stop robots and that people step over, m.
    """

    walls: Array
    stops_robot: NDArray[np.bool_]
    stops_crowd: NDArray[np.bool_]
    pillars: Array = field(default_factory=lambda: np.zeros((0, 3)))
    blocks: tuple[Array, ...] = ()
    steps: tuple[Array, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ShownRun:
    """One run on the page.

    Attributes:
        run: the run, with or without robot and people.
        title: e.g. the scenario's id and the planner.
        label: label beside other runs, e.g. the planner; default: the title.
        facts: name -> text; ``Status`` is shown beside the title.
        words: one sentence that says what the scenario's words mean; may be empty.
        scans: readings of lidars, ultrasounds and infrared sensors; drawn from the robot's true
            pose.
        images: camera images.
        drawings: what the planner drew, by name, in the robot's base frame.
        scores: shown beside the run; may be empty.
        look: parts of the robot seen from above, lowest first, in its frame; without any, its
            outline and an arrow.
        robot: name of the run's robot, if there are others.
        others: the other robots of a fleet.
        scenery: default: the run's walls, which stop robots and people.
        solids: what the view in three dimensions needs, `crowdbot.core.runs.solids`; without it
            there is none.
    """

    run: Trajectories
    title: str
    label: str = ""
    facts: Mapping[str, str] = field(default_factory=dict)
    words: str = ""
    scans: Sequence[ReplayScan] = ()
    images: Sequence[ReplayImages] = ()
    drawings: Mapping[str, Sequence[PlannerDrawing]] = field(default_factory=dict)
    scores: Sequence[Score] = ()
    look: Sequence[Seen] = ()
    robot: str = "robot"
    others: Sequence[OtherTrack] = ()
    scenery: Scenery | None = None
    solids: Mapping[str, Any] | None = None

    @property
    def status(self) -> str:
        """Return how it ended; empty if unknown."""
        return next((v for k, v in self.facts.items() if k.lower() == "status"), "")
