"""Forces on a robot: those of people, and those of other robots."""

from __future__ import annotations

from pydrake.systems.framework import BasicVector, Context, DiagramBuilder

from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.contacts.robot_contacts import RobotContacts
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES, weak_callback


class PushSum(Block):
    """Inputs: forces of people and of robots. Output: their sum, in the control mode's layout."""

    __slots__ = NO_ATTRIBUTES

    def __init__(self, robot: ControlledRobot, *, people: bool) -> None:
        super().__init__()
        self._layout, size = robot.push, robot.push.size
        self._people = self.DeclareVectorInputPort(ports.CROWD_STATE, size) if people else None
        self._robots = self.DeclareVectorInputPort(ports.ROBOT_PUSH, ports.ROBOT_PUSH_SIZE)
        self.DeclareVectorOutputPort(ports.ROBOT_FORCE, size, weak_callback(self._calc))

    def _calc(self, context: Context, output: BasicVector) -> None:
        values = output.get_mutable_value()
        values[:] = 0.0
        self._layout.write(values, *self._robots.Eval(context).tolist())
        if self._people is not None:
            values += self._people.Eval(context)


def connect_pushes(
    builder: DiagramBuilder,
    k: int,
    robot: ControlledRobot,
    crowd: CrowdSystem | None,
    contacts: RobotContacts | None,
) -> None:
    """Let people and other robots push robot k, if anything can."""
    if robot.push_port is None:
        return
    if contacts is None:
        if crowd is not None:
            builder.Connect(crowd.force_on(k), robot.push_port)
        return
    total = builder.AddSystem(PushSum(robot, people=crowd is not None))
    if crowd is not None:
        builder.Connect(crowd.force_on(k), total.GetInputPort(ports.CROWD_STATE))
    builder.Connect(contacts.on(k), total.GetInputPort(ports.ROBOT_PUSH))
    builder.Connect(total.GetOutputPort(ports.ROBOT_FORCE), robot.push_port)
