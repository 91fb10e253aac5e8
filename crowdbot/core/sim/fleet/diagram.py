"""build_fleet: one diagram of several robots, wired like `crowdbot.core.sim.diagram`."""

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
from crowdbot.core.sim.companion import Companion, Company
from crowdbot.core.sim.control import ControlledRobot, add_robot
from crowdbot.core.sim.crowd_system import CrowdSystem, add_crowd
from crowdbot.core.sim.fate import Fate
from crowdbot.core.sim.fleet.people_logger import PeopleLogger, add_people_logger
from crowdbot.core.sim.fleet.pushes import connect_pushes
from crowdbot.core.sim.fleet.recorder import add_fleet_recorder
from crowdbot.core.sim.fleet.robot_contacts import FleetContacts, add_fleet_contacts
from crowdbot.core.sim.metric_logger import MetricLogger, add_metric_logger
from crowdbot.core.sim.planner_system import add_planner
from crowdbot.core.sim.sensor_bank import add_sensors


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetRobot:
    """One robot of a fleet, with its planner and ending.

    Attributes:
        built: its model, sensors and task.
        host: its planner.
        log: log of its recording.
        fate: its ending.
        privileged: True if its planner gets ground truth.
    """

    built: BuiltRun
    host: PlannerHost
    log: RunLog
    fate: Fate
    privileged: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetBlocks:
    """A finished diagram and its named parts; those of robots in order."""

    diagram: Diagram
    robots: tuple[ControlledRobot, ...]
    loggers: tuple[MetricLogger, ...]
    people: PeopleLogger
    crowd: CrowdSystem | None
    contacts: FleetContacts


def build_fleet(
    fleet: Sequence[FleetRobot], engine: CrowdEngine | None, log: RunLog, *, seed: int
) -> FleetBlocks:
    """Wire a run of several robots.

    Args:
        fleet: the robots, of one scenario.
        engine: the people, or None.
        log: log of the people's recording.
        seed: seed of the sensors' noise, with separate streams per robot.
    """
    builder = DiagramBuilder()
    builts, fates = [r.built for r in fleet], [r.fate for r in fleet]

    robots = []
    for built in builts:
        with _named(builder, built.name):
            robots.append(add_robot(builder, built.parts, built.model, built.robot.control))

    crowd = add_crowd(builder, builts, robots, engine, fates)
    models = [built.model for built in builts]
    contacts = add_fleet_contacts(builder, models, robots, fates, [r.log for r in fleet])

    loggers = []
    for k, one in enumerate(fleet):
        with _named(builder, one.built.name):
            connect_pushes(builder, k, robots[k], crowd, contacts)
            loggers.append(_add_mind(builder, fleet, k, robots, crowd, contacts, seed))

    rate = builts[0].scenario.rates.log
    people = add_people_logger(builder, crowd, log, rate, fates)
    add_fleet_recorder(builder, [r.log.writer for r in fleet], log.writer)
    return FleetBlocks(
        diagram=builder.Build(),
        robots=tuple(robots),
        loggers=tuple(loggers),
        people=people,
        crowd=crowd,
        contacts=contacts,
    )


def _add_mind(
    builder: DiagramBuilder,
    fleet: Sequence[FleetRobot],
    k: int,
    robots: Sequence[ControlledRobot],
    crowd: CrowdSystem | None,
    contacts: FleetContacts,
    seed: int,
) -> MetricLogger:
    """Add sensors, planner and monitor of robot k, which sees and meets all others."""
    one, robot = fleet[k], robots[k]
    rest = [i for i in range(len(fleet)) if i != k]
    others = [Companion(fleet[i].built.model, robots[i].port) for i in rest]
    fates = [one.fate, *(fleet[i].fate for i in rest)]
    company = Company(k, fates, others, contacts.on(k))
    bank = add_sensors(
        builder, one.built, robot, crowd, one.log.writer,
        seed=seed, company=company,
    )  # fmt: skip
    add_planner(
        builder, one.built, robot, crowd, bank, one.host, one.log,
        privileged=one.privileged, company=company,
    )  # fmt: skip
    end = partial(contacts.finish, k)
    return add_metric_logger(builder, one.built, robot, crowd, one.log, one.fate, end)


@contextmanager
def _named(builder: DiagramBuilder, robot: str) -> Iterator[None]:
    """Prefix the names of all systems added in the context with the robot's name."""
    before = len(builder.GetSystems())
    yield
    for system in builder.GetSystems()[before:]:
        system.set_name(f"{robot}/{system.get_name() or 'push'}")
