"""Check that a robot moves as commanded: ahead, turning, and sideways. Needs Drake.

The robot alone stands on an empty floor; there is no scenario, no planner and no recording.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.build import MODES, build_model
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.robot import RobotModel, RobotState
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.component_specs import RobotSpec
from crowdbot.testing.around import around, specs_of

#: Seconds to reach the speed, and seconds of measurement.
_SETTLE, _MEASURE = 1.0, 1.0
_SPEED, _RATE = 0.2, 0.5  # m/s, rad/s
_SHARE = 0.05  # share of the commanded value


def check_commanded_motion(component: Component[Any], registry: Registry | None = None) -> None:
    """In every control mode of its drive the robot moves as commanded: ahead, turning, sideways.

    If this fails, wheels are in the wrong place, turn backwards, do not touch the floor, or another
    part rubs on it; compare joints, radius, track and base_height with the description.
    """
    known = around(component, registry)
    for spec in specs_of(component, known):
        assert isinstance(spec, RobotSpec)
        model = build_model(known, spec)
        for mode in MODES[type(model.drive)]:
            for command in commands_for(model):
                assert_moves(model, mode, command)


def commands_for(model: RobotModel) -> list[Command]:
    """Return one command for each direction in which a robot can move."""
    limits = model.limits
    commands = [Command(min(_SPEED, limits.v_max), 0.0), Command(0.0, min(_RATE, limits.w_max))]
    if limits.v_min < 0.0:
        commands.append(Command(max(-_SPEED, limits.v_min), 0.0))
    if limits.vy_max:
        commands.append(Command(0.0, 0.0, min(_SPEED, limits.vy_max)))
    return commands


def assert_moves(model: RobotModel, mode: str, command: Command) -> None:
    """Drive for two seconds and compare the second one with the command."""
    ended = drive(model, mode, command, _SETTLE + _MEASURE)
    middle, end = ended[round(_SETTLE / TICK)], ended[-1]
    turn = math.remainder(end.yaw - middle.yaw, 2.0 * math.pi)
    way = middle.yaw + 0.5 * turn
    dx, dy = end.x - middle.x, end.y - middle.y
    moved = Command(
        math.cos(way) * dx + math.sin(way) * dy,
        turn,
        math.cos(way) * dy - math.sin(way) * dx,
    )
    expected = [x * _MEASURE for x in command]
    slack = [_SHARE * max(abs(x), 0.1) for x in expected]
    prefix = f"{mode}: told {tuple(command)} (m/s, rad/s, m/s to the left) for {_MEASURE:g} s, it "
    for got, want, most in zip(moved, expected, slack, strict=True):
        text = f"{prefix}moved {np.round(moved, 4).tolist()} (m, rad, m)"
        assert abs(got - want) <= most, text
    assert end.tilt < math.radians(5.0), f"{prefix}tilted by {math.degrees(end.tilt):.1f} degrees"


def drive(model: RobotModel, mode: str, command: Command, seconds: float) -> list[RobotState]:
    """Return the states, one per tick, of a robot that starts at rest and gets a ramped command."""
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder
    from pydrake.systems.primitives import ConstantVectorSource

    from crowdbot.core.sim import ports
    from crowdbot.core.sim.control import add_robot

    builder = DiagramBuilder()
    robot = add_robot(builder, EMPTY_FLOOR, model, mode)
    source = builder.AddSystem(ConstantVectorSource(np.zeros(robot.desired_size)))
    builder.Connect(source.get_output_port(), robot.desired)
    simulator = Simulator(builder.Build())
    context = simulator.get_mutable_context()
    robot.place(context, Pose(0.0, 0.0, 0.0))
    source_value = source.get_mutable_source_value(source.GetMyMutableContextFromRoot(context))
    states = []
    for tick in range(round(seconds / TICK) + 1):
        share = min(1.0, tick * TICK / (0.5 * _SETTLE))
        v, w, vy = (share * x for x in command)
        source_value.set_value(np.array(robot.desire(v, w, vy)))
        simulator.AdvanceTo(tick * TICK)
        mine = robot.state.GetMyContextFromRoot(context)
        port = robot.state.GetOutputPort(ports.ROBOT_STATE)
        states.append(RobotState(*port.Eval(mine).tolist()))
    return states


EMPTY_FLOOR = EnvironmentParts(
    walls=np.zeros((0, 4)),
    wall_heights=np.zeros((0, 2)),
    stops_robot=np.zeros(0, np.bool_),
    stops_crowd=np.zeros(0, np.bool_),
    zones={},
    portals={},
)
