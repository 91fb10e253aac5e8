"""build_diagram: build a Drake diagram from a built run and a planner."""

from __future__ import annotations

from dataclasses import dataclass

from pydrake.systems.framework import Diagram, DiagramBuilder

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.planning.host import PlannerHost
from crowdbot.core.recording.run_log import RunLog
from crowdbot.core.sim.built_run import BuiltRun
from crowdbot.core.sim.control import ControlledRobot, add_robot
from crowdbot.core.sim.crowd_system import CrowdSystem, add_crowd
from crowdbot.core.sim.fate import Fate
from crowdbot.core.sim.metric_logger import MetricLogger, add_metric_logger
from crowdbot.core.sim.planner_system import PlannerSystem, add_planner
from crowdbot.core.sim.recorder import add_recorder
from crowdbot.core.sim.sensor_bank import SensorBank, add_sensors
from crowdbot.core.support.ticks import TICK


@dataclass(frozen=True, slots=True, kw_only=True)
class Blocks:
    """A finished diagram and its named parts. Never look anything up by index."""

    diagram: Diagram
    robot: ControlledRobot
    bank: SensorBank
    planner: PlannerSystem
    logger: MetricLogger
    crowd: CrowdSystem | None


def build_diagram(
    built: BuiltRun,
    engine: CrowdEngine | None,
    host: PlannerHost,
    log: RunLog,
    *,
    seed: int,
    privileged: bool = False,
    tick: float = TICK,
) -> Blocks:
    """Wire one run.

    Args:
        built: environment, robot and sensors.
        engine: the people, or None.
        host: the planner.
        log: log of the recording.
        seed: seed of the sensors' noise.
        privileged: True if the planner gets ground truth.
        tick: s, time step of plant, people and their contacts; other values are for studies of
            contacts, see `CrowdEngine.advance`.
    """
    builder = DiagramBuilder()

    # Robot: converts commands to motion, and outputs its state as one vector.
    robot = add_robot(builder, built.parts, built.model, built.robot.control, tick)

    # Crowd and contact in one event: force on the robot, reaction on people.
    crowd = add_crowd(builder, [built], [robot], engine, [Fate()], tick)
    if crowd is not None and robot.push_port is not None:
        builder.Connect(crowd.force_on(0), robot.push_port)

    # Sensors, including odometry.
    bank = add_sensors(builder, built, robot, crowd, log.writer, seed=seed)

    # Planner, slew limits, control mode.
    planner = add_planner(builder, built, robot, crowd, bank, host, log, privileged=privileged)

    # End of the run, and samples.
    logger = add_metric_logger(builder, built, robot, crowd, log)

    # Chunks of the recording.
    add_recorder(builder, log.writer)

    return Blocks(
        diagram=builder.Build(),
        robot=robot,
        bank=bank,
        planner=planner,
        logger=logger,
        crowd=crowd,
    )
