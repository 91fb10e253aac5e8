"""PlannerSystem: the planner, then command timeout and slew limits, then the control mode's input.

Discrete events run after unrestricted ones, so a planner step sees the readings of its own tick.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from pydrake.systems.framework import (
    Context,
    DiagramBuilder,
    DiscreteStateIndex,
    DiscreteValues,
)

from crowdbot.core.assistance.finder import PersonSight
from crowdbot.core.assistance.guide import PersonGuide
from crowdbot.core.assistance.target import lidars_of
from crowdbot.core.planning.drawn import Drawn, DrawnRows
from crowdbot.core.planning.host import STOP, HostedCommand, PlannerHost
from crowdbot.core.planning.planner import (
    Observation,
    SignalBounds,
    Truth,
    drawing_bounds,
    named_drawing,
    named_signal,
)
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.recording.topics import is_odometry
from crowdbot.core.sim import ports
from crowdbot.core.sim.block import Block
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.control import ControlledRobot
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.other_robots import OtherRobots
from crowdbot.core.sim.person_targets import guide_of, relative_people
from crowdbot.core.sim.planner_truth import TruthSource, truth_source
from crowdbot.core.sim.sensor_bank import SensorBank
from crowdbot.core.sim.weak_callback import NO_ATTRIBUTES
from crowdbot.core.support.ticks import TICK, TICKS_PER_SECOND, ticks
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.robot import RobotLimits, RobotState
from crowdbot.core.types.task import Task
from crowdbot.errors import PlannerError


class GuideInputs(NamedTuple):
    """A guide, the people it is about as a function of robot and crowd state, and its lidars."""

    guide: PersonGuide
    relative: Callable[[Array, Array], Array]
    lidars: tuple[str, ...]


class PlannerSystem(Block):
    """Input: readings; robot and crowd for a privileged planner. Outputs: command, desired state.

    The command is the planner's; the desired state is the control mode's input.
    """

    __slots__ = NO_ATTRIBUTES

    def __init__(
        self,
        host: PlannerHost,
        bank: SensorBank,
        robot: ControlledRobot,
        limits: RobotLimits,
        task: Task,
        *,
        rate: float,
        visible: Mapping[str, None],
        on_step: Callable[[float, HostedCommand], None],
        on_signal: Callable[[float, str, float], None],
        on_drawing: Callable[[float, Drawn], None],
        wants_drawing: Callable[[float, str], bool],
        people: TruthSource | None = None,
        guided: GuideInputs | None = None,
        crowd_size: int = 0,
        others: OtherRobots,
    ) -> None:
        """Connect a planner with its sensors and its robot.

        Args:
            wants_drawing: True if ``on_drawing`` would keep a drawing of this time and name.
            people: true data of the people, for a privileged planner; None for all others.
            guided: tells the planner where the person of its task is, if there is one.
            crowd_size: length of the state vector of all people.
            others: the other robots, and the ending of this one.
        """
        super().__init__()
        self._host, self._desire, self._task = host, robot.desire, task
        self._dv, self._dw = limits.a_max * TICK, limits.alpha_max * TICK
        self._ticks = ticks(rate)
        patience = limits.command_timeout * TICKS_PER_SECOND
        self._timeout = math.ceil(patience) if math.isfinite(patience) else -1
        self._bank = bank
        self._slots = {n: s for n, s in bank.slots.items() if n in visible}
        self._odometry = next((s for s in bank.slots.values() if is_odometry(s.info)), None)
        self._on_step, self._on_signal, self._bounds = on_step, on_signal, SignalBounds()
        self._on_drawing, self._drawn = on_drawing, drawing_bounds()
        self._wants_drawing = wants_drawing
        self._port = self.DeclareVectorInputPort(
            ports.READINGS, bank.GetOutputPort(ports.READINGS).size()
        )
        self._people, self._guided = people, guided
        self._robot = self._crowd = None
        if people is not None or guided is not None:
            self._robot = self.DeclareVectorInputPort(ports.ROBOT_STATE, ports.ROBOT_STATE_SIZE)
            if crowd_size:
                self._crowd = self.DeclareVectorInputPort(ports.CROWD_STATE, crowd_size)
        self._ending, self._others = others.ending, others
        known = range(0 if people is None else len(others.states))
        self._states = [self.DeclareVectorInputPort(*ports.other_robot(k)) for k in known]
        command = self.DeclareDiscreteState(ports.COMMAND_SIZE)
        desired = self.DeclareDiscreteState(robot.desired_size)
        self.DeclareStateOutputPort(ports.COMMAND, command)
        self.DeclareStateOutputPort(ports.DESIRED_STATE, desired)
        self._command, self._desired = DiscreteStateIndex(command), DiscreteStateIndex(desired)
        self.DeclarePeriodicDiscreteUpdateEvent(TICK, 0.0, self._update)

    def _update(self, context: Context, values: DiscreteValues) -> None:
        state = values.get_mutable_value(self._command)
        tick, v, w, vy, slewed_v, slewed_w, slewed_vy = state.tolist()
        since = int(tick) % self._ticks
        due = since == 0
        if self._ending.ended or self._ending.failure:
            due, v, w, vy = False, 0.0, 0.0, 0.0
        if since == self._timeout:  # without commands, the driver stops the robot
            v = w = vy = 0.0
        if not due and slewed_v == v and slewed_w == w and slewed_vy == vy:
            state[0] = tick + 1.0  # everything else is unchanged
            return
        if due:
            t = tick * TICK
            v, w, vy = self._ask(context, t)
        slewed_v, slewed_vy = _slew_planar(slewed_v, slewed_vy, v, vy, self._dv)
        slewed_w = _slew(slewed_w, w, self._dw)
        state[:] = (tick + 1.0, v, w, vy, slewed_v, slewed_w, slewed_vy)
        values.get_mutable_value(self._desired)[:] = self._desire(slewed_v, slewed_w, slewed_vy)

    def _ask(self, context: Context, t: float) -> Command:
        """Return the planner's command.

        If the planner fails, end the robot, and with the only robot the run.
        """
        seen = self._seen(context, t)
        try:
            hosted = self._host.step(seen)
        except PlannerError as error:
            self._ending.failure = str(error)
            if not self._others.endings:
                raise
            return STOP
        self._on_step(t, hosted)
        return hosted.command

    def observation(self, root: Context) -> Observation | None:
        """Return the planner's observation at the current step; None if the robot has ended."""
        if self._ending.ended or self._ending.failure:
            return None
        context = self.GetMyContextFromRoot(root)
        t = context.get_discrete_state(self._command).value().item(0) * TICK
        return self._seen(context, t)

    def _seen(self, context: Context, t: float) -> Observation:
        """Return the planner's observation; in a task about a person with the person's pose."""
        bank = self._port.Eval(context)
        obs = self._observe(bank, t, self._truth(context))
        if self._guided is None or self._robot is None or self._crowd is None:
            return obs
        guide, relative, lidars = self._guided
        found = guide.update(
            PersonSight(
                t=t,
                pose=obs.pose,
                twist=obs.twist,
                vy=obs.vy,
                readings={
                    n: self._bank.reading(n, bank)
                    for n in lidars
                    if bank[self._bank.slots[n].stamp] >= 0.0
                },
                relative=relative(self._robot.Eval(context), self._crowd.Eval(context)),
            )
        )
        return replace(obs, person=found.person, goal=found.goal, goal_zone=found.goal_zone)

    def _truth(self, context: Context) -> Truth | None:
        """Return the ground truth, if the planner is privileged."""
        if self._people is None or self._robot is None:
            return None
        robot = RobotState(*self._robot.Eval(context).tolist())
        crowd = np.zeros(0) if self._crowd is None else self._crowd.Eval(context)
        others = [
            None if ending.gone else RobotState(*port.Eval(context).tolist())
            for ending, port in zip(self._others.endings, self._states, strict=True)
        ]
        return self._people.truth(robot, crowd, others)

    def _signal(self, t: float, name: str, value: float) -> None:
        self._bounds.check(name)
        self._on_signal(t, name, value)

    def _draw(self, t: float, name: str, rows: DrawnRows, text: str | Sequence[str] | None) -> None:
        if callable(rows):
            named_signal(name, 0.0)  # a wrong name is an error even if nothing is kept
            if not self._wants_drawing(t, name):
                return
        drawn = named_drawing(name, rows, text)
        self._drawn.check(drawn.name, drawn.size)
        self._on_drawing(t, drawn)

    def _observe(self, bank: Array, t: float, truth: Truth | None) -> Observation:
        pose, twist, sideways = self._task.start, (0.0, 0.0), [0.0]
        if self._odometry is not None:
            x, y, yaw, v, w, *sideways = bank[self._odometry.values].tolist()
            pose, twist = Pose(x, y, yaw), (v, w)
        return Observation(
            t=t,
            pose=pose,
            twist=twist,
            vy=sideways[0] if sideways else 0.0,
            goal=self._task.goal,
            goal_zone=self._task.goal_zone,
            readings={
                n: self._bank.reading(n, bank)
                for n, s in self._slots.items()
                if bank[s.stamp] >= 0.0
            },
            log=lambda name, value: self._signal(t, *named_signal(name, value)),
            draw=lambda name, rows, text=None: self._draw(t, name, rows, text),
            truth=truth,
        )


def _slew_planar(
    v: float, vy: float, wanted_v: float, wanted_vy: float, step: float
) -> tuple[float, float]:
    """Move a vector towards another by at most ``step``."""
    if vy == wanted_vy:
        return _slew(v, wanted_v, step), vy
    ahead, aside = wanted_v - v, wanted_vy - vy
    length = math.hypot(ahead, aside)
    if length <= step:
        return wanted_v, wanted_vy
    return v + ahead * step / length, vy + aside * step / length


def _slew(now: float, target: float, step: float) -> float:
    return now + min(step, max(-step, target - now))


def add_planner(
    builder: DiagramBuilder,
    built: BuiltRun,
    robot: ControlledRobot,
    crowd: CrowdSystem | None,
    bank: SensorBank,
    host: PlannerHost,
    log: RunLog,
    others: OtherRobots,
    *,
    privileged: bool,
    seed: int,
) -> PlannerSystem:
    """Add the planner to a diagram, between the readings and the robot's desired state.

    ``seed`` is that of the run.
    """
    guided = _guided(built, seed)
    planner = PlannerSystem(
        host, bank, robot, built.model.limits, built.task,
        rate=built.scenario.rates.planner, visible=dict.fromkeys(built.visible),
        on_step=lambda t, step: log.command(t, step.command, step.seconds, step.clamped),
        on_signal=log.writer.signal,
        on_drawing=log.drawing,
        wants_drawing=log.wants_drawing,
        people=truth_source(crowd, others.models) if privileged else None,
        guided=guided,
        crowd_size=0 if crowd is None else crowd.state.size(),
        others=others,
    )  # fmt: skip
    builder.AddNamedSystem("planner", planner)
    builder.Connect(bank.GetOutputPort(ports.READINGS), planner.GetInputPort(ports.READINGS))
    builder.Connect(planner.GetOutputPort(ports.DESIRED_STATE), robot.desired)
    if privileged or guided is not None:
        builder.Connect(robot.port, planner.GetInputPort(ports.ROBOT_STATE))
        if crowd is not None:
            builder.Connect(crowd.state, planner.GetInputPort(ports.CROWD_STATE))
    if privileged:
        for k, state in enumerate(others.states):
            builder.Connect(state, planner.GetInputPort(ports.other_robot(k)[0]))
    return planner


def _guided(built: BuiltRun, seed: int) -> GuideInputs | None:
    guide = guide_of(built, seed)
    if guide is None or built.target is None:
        return None
    return GuideInputs(guide, relative_people(built.target), tuple(lidars_of(built.infos)))
