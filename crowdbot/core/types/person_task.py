"""A task whose goal is a person, and the robot's knowledge of the person."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.types.arrays import Array

#: What a robot does with a person.
PersonTaskKind = Literal["approach", "follow", "accompany", "lead"]
#: Side of the person to go on, as the person sees it.
PersonSide = Literal["left", "right", "either"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonTask:
    """A goal that is a person or a group; SI units.

    The robot is in place if the gap between the surfaces of robot and person is ``distance`` +-
    ``tolerance``, in a direction from the person that differs by at most ``angle`` from the wanted
    one (ahead of the person for ``approach`` and ``lead``, behind for ``follow``, aside for
    ``accompany``), with the heading that the task requires.

    Attributes:
        kind: what to do.
        distance, tolerance, angle: m, m, rad.
        hold: the task is done after this time in place, s; 0 of ``lead``, which is done when the
            robot is in the goal zone and the gap at most ``distance`` + ``tolerance``.
        in_a_row: True if that time counts only without interruption.
        knows: ``tracked`` or ``told``, as in the scenario.
        radius: of the person, or of the circle around the group, m.
        side: side of the person to go on; of ``accompany``.
    """

    kind: PersonTaskKind
    distance: float
    tolerance: float
    angle: float
    hold: float = 0.0
    in_a_row: bool = False
    knows: Literal["tracked", "told"] = "tracked"
    radius: float = 0.33
    side: PersonSide = "either"


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonEstimate:
    """The robot's knowledge of the person, or of the group's centre, in the frame of odometry.

    Attributes:
        x, y: m.
        heading: where the person faces, rad; of a group whose members face each other NaN.
        vx, vy: m/s.
        age: since the person was last seen, or told of, s.
    """

    x: float
    y: float
    heading: float
    vx: float
    vy: float
    age: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskPerson:
    """A task about a person, and the person's id.

    Attributes:
        task: what to do.
        id: (M,) numbers of the people: one, or those of a group.
        facing: (M,) where they face at the start, rad.
    """

    task: PersonTask
    id: NDArray[np.int64]
    facing: Array
