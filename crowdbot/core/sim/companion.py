"""Other robots of the same run, as used by one robot's blocks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pydrake.systems.framework import OutputPort

from crowdbot.core.sim.fate import Fate
from crowdbot.core.types.robot import RobotModel


@dataclass(frozen=True, slots=True)
class Company:
    """The fleet, as used by one robot's blocks.

    Attributes:
        number: of the robot among all.
        fates: of the robot itself, then of the others.
        others: the others.
        push: force that they exert on the robot.
    """

    number: int
    fates: Sequence[Fate]
    others: Sequence[Companion]
    push: OutputPort


@dataclass(frozen=True, slots=True)
class Companion:
    """Another robot's model, and the port with its state."""

    model: RobotModel
    port: OutputPort
