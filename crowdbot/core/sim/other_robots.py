"""The other robots of a run: the data that the systems of one robot need about them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pydrake.systems.framework import OutputPort

from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.types.robot import RobotModel


@dataclass(frozen=True, slots=True)
class OtherRobots:
    """The other robots, and the ending of the robot itself.

    Attributes:
        ending: of the robot itself.
        number: of the robot itself, in the order of all.
        models, states, endings: of the others: what they are, the ports with their states, and
            how they have ended.
        push: port of their forces on the robot; None without other robots.
        end_contacts: ends the contacts with them that are going on.
    """

    ending: RobotEnding
    number: int = 0
    models: Sequence[RobotModel] = ()
    states: Sequence[OutputPort] = ()
    endings: Sequence[RobotEnding] = ()
    push: OutputPort | None = None
    end_contacts: Callable[[], None] = lambda: None
