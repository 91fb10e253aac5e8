"""Companion: another robot of the same run, as the blocks of one robot know it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pydrake.systems.framework import OutputPort

from crowdbot.core.sim.fate import Fate
from crowdbot.core.types.robot import RobotModel


@dataclass(frozen=True, slots=True)
class Company:
    """What the blocks of one robot of a fleet know of the fleet.

    Attributes:
        number: of the robot among all.
        fates: of the robot itself, then of the others.
        others: the others.
        push: what they exert on the robot.
    """

    number: int
    fates: Sequence[Fate]
    others: Sequence[Companion]
    push: OutputPort


@dataclass(frozen=True, slots=True)
class Companion:
    """What it is, and the port with its state."""

    model: RobotModel
    port: OutputPort
