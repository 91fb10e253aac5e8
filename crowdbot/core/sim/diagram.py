"""build_diagram: one straight recipe from built robots and their planners to a Drake diagram."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

from pydrake.systems.framework import Diagram, DiagramBuilder

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.contacts.pushes import connect_pushes
from crowdbot.core.sim.contacts.robot_contacts import RobotContacts, add_robot_contacts
from crowdbot.core.sim.control import ControlledRobot, add_robot
from crowdbot.core.sim.crowd_system import CrowdSystem, add_crowd
from crowdbot.core.sim.loggers.metric_logger import MetricLogger, add_metric_logger
from crowdbot.core.sim.loggers.people_logger import PeopleLogger, add_people_logger
from crowdbot.core.sim.loggers.recorder import add_recorder
from crowdbot.core.sim.other_robots import OtherRobots
from crowdbot.core.sim.planner_system import PlannerSystem, add_planner
from crowdbot.core.sim.robot_ending import RobotEnding
from crowdbot.core.sim.sensor_bank import SensorBank, add_sensors
from crowdbot.core.support.ticks import TICK


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRobot:
    """One robot of a run, with what decides about it.

    Attributes:
        built: its model, sensors and task.
        host: its planner.
        log: records it.
        ending: how it has ended.
        privileged: True if its planner sees the truth.
    """

    built: BuiltRun
    host: PlannerHost
    log: RunLog
    ending: RobotEnding
    privileged: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotBlocks:
    """The systems of one robot in a Drake diagram."""

    given: RunRobot
    base: ControlledRobot
    bank: SensorBank
    planner: PlannerSystem
    logger: MetricLogger


@dataclass(frozen=True, slots=True, kw_only=True)
class Blocks:
    """A finished diagram and its named parts. Never look anything up by index.

    Attributes:
        robots: in the scenario's order.
        people: samples people where the log of no robot does.
    """

    diagram: Diagram
    robots: tuple[RobotBlocks, ...]
    crowd: CrowdSystem | None
    people: PeopleLogger | None


def build_diagram(
    robots: Sequence[RunRobot],
    engine: CrowdEngine | None,
    people: RunLog,
    *,
    seed: int,
    tick: float = TICK,
) -> Blocks:
    """Wire one run.

    Args:
        robots: one or several robots of one scenario.
        engine: the people; None where there are none.
        people: takes what is recorded of them; that of the robot where it is the only one.
        seed: of the run: noise of the sensors, of which each robot has streams of its own.
        tick: s, of plant, people and their contacts; another one is for studies of contacts, see
            `CrowdEngine.advance`.
    """
    builder = DiagramBuilder()
    builts = [robot.built for robot in robots]

    # Robots: how commands become motion, and the one vector that stands for the state of each.
    bases = []
    for k, built in enumerate(builts):
        with _named(builder, robots, k):
            bases.append(add_robot(builder, built.parts, built.model, built.robot.control, tick))

    # Crowd and contact, one event: forces on robots, reactions on people. Robots among themselves.
    endings, logs = [robot.ending for robot in robots], [robot.log for robot in robots]
    crowd = add_crowd(builder, builts, bases, engine, endings, tick)
    contacts = add_robot_contacts(builder, builts, bases, endings, logs)

    # Sensors, planner and watch of each robot.
    found = []
    for k in range(len(robots)):
        with _named(builder, robots, k):
            connect_pushes(builder, k, bases[k], crowd, contacts)
            others = _others(robots, bases, k, contacts)
            one = _add_sensors_and_planner(builder, robots[k], bases[k], crowd, others, seed)
            found.append(one)

    # What takes the samples of people, and what closes the chunks of the recording.
    shared = [] if people in logs else [people]
    rate = builts[0].scenario.rates.log
    loggers = [add_people_logger(builder, crowd, log, rate) for log in shared]
    add_recorder(builder, [log.writer for log in (*logs, *shared)])

    return Blocks(
        diagram=builder.Build(),
        robots=tuple(found),
        crowd=crowd,
        people=loggers[0] if loggers else None,
    )


def _others(
    robots: Sequence[RunRobot],
    bases: Sequence[ControlledRobot],
    k: int,
    contacts: RobotContacts | None,
) -> OtherRobots:
    """Return the data about all robots but robot k that the systems of robot k need."""
    if contacts is None:
        return OtherRobots(robots[k].ending)
    rest = [i for i in range(len(robots)) if i != k]
    return OtherRobots(
        robots[k].ending,
        number=k,
        models=[robots[i].built.model for i in rest],
        states=[bases[i].port for i in rest],
        endings=[robots[i].ending for i in rest],
        push=contacts.on(k),
        end_contacts=partial(contacts.finish, k),
    )


def _add_sensors_and_planner(
    builder: DiagramBuilder,
    robot: RunRobot,
    base: ControlledRobot,
    crowd: CrowdSystem | None,
    others: OtherRobots,
    seed: int,
) -> RobotBlocks:
    """Add sensors, planner and watch of a robot, which sees and meets all others."""
    # Sensors, odometry among them.
    bank = add_sensors(builder, robot.built, base, crowd, robot.log.writer, others, seed=seed)

    # Planner, slew limits, control mode.
    planner = add_planner(
        builder, robot.built, base, crowd, bank, robot.host, robot.log, others,
        privileged=robot.privileged, seed=seed,
    )  # fmt: skip

    # What ends the robot, and the run with the last one, and takes its samples.
    logger = add_metric_logger(builder, robot.built, base, crowd, robot.log, others)
    return RobotBlocks(given=robot, base=base, bank=bank, planner=planner, logger=logger)


@contextmanager
def _named(builder: DiagramBuilder, robots: Sequence[RunRobot], k: int) -> Iterator[None]:
    """Put the name of one robot of several before those of systems that are added within this."""
    before = len(builder.GetSystems())
    yield
    if len(robots) > 1:
        for system in builder.GetSystems()[before:]:
            system.set_name(f"{robots[k].built.name}/{system.get_name() or 'push'}")
