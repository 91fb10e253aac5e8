"""build_diagram: one straight recipe from a scenario and a planner to a Drake diagram."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
from pydrake.systems.framework import Diagram, DiagramBuilder

from crowdbot.core.crowd import CrowdEngine
from crowdbot.core.crowd import state as crowd_state
from crowdbot.core.interfaces import EnvironmentParts, Pose, RobotModel, SensorInfo, Task
from crowdbot.core.planner_host import HostedCommand, PlannerHost
from crowdbot.core.registry import Registry
from crowdbot.core.run_log import RunLog
from crowdbot.core.sensing.guard import build_sensor
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.sim import ports
from crowdbot.core.sim.control import ControlledRobot, add_robot
from crowdbot.core.sim.crowd_system import CrowdSystem
from crowdbot.core.sim.images import Painter
from crowdbot.core.sim.metric_logger import MetricLogger
from crowdbot.core.sim.planner_system import People, PlannerSystem
from crowdbot.core.sim.recorder import Recorder
from crowdbot.core.sim.sensor_bank import SensorBank
from crowdbot.core.sim.wall_contact import WallContacts
from crowdbot.core.ticks import TICK
from crowdbot.dsl.scenario import Robot, Scenario


@dataclass(frozen=True, slots=True, kw_only=True)
class Blocks:
    """A finished diagram and its named parts. Never look anything up by index."""

    diagram: Diagram
    robot: ControlledRobot
    bank: SensorBank
    planner: PlannerSystem
    logger: MetricLogger
    walls: WallContacts
    crowd: CrowdSystem | None


def robot_task(robot: Robot, parts: EnvironmentParts) -> Task:
    """The robot's task with its goal zone as a polygon."""
    zone = parts.zones[robot.task.goal.zone]
    centre = zone.mean(axis=0)
    return Task(
        start=Pose(*robot.task.start),
        goal=(float(centre[0]), float(centre[1])),
        goal_zone=zone,
        time_limit=robot.task.time_limit,
    )


def build_diagram(
    scenario: Scenario,
    robot_name: str,
    parts: EnvironmentParts,
    model: RobotModel,
    engine: CrowdEngine | None,
    host: PlannerHost,
    log: RunLog,
    registry: Registry,
    *,
    run_seed: int,
    sensors: Collection[str],
    visible: Collection[str],
    privileged: bool = False,
    tick: float = TICK,
) -> Blocks:
    """Wire one run.

    Args:
        sensors: names of the sensors to simulate; readings do not depend on which others run.
        visible: names of those that the planner asked for.
        privileged: whether the planner sees the truth.
        tick: s, of plant, people and their contacts; another one is for studies of contacts, see
            `CrowdEngine.advance`.
    """
    robot = scenario.robots[robot_name]
    task = robot_task(robot, parts)
    builder = DiagramBuilder()

    # Robot: how commands become motion, and the one vector that stands for its state.
    body = add_robot(builder, parts, model, robot.control, tick)
    robot_state = body.state.GetOutputPort(ports.ROBOT_STATE)

    # Crowd and contact, one event: force on the robot, reaction on people.
    crowd, size = None, 0
    if engine is not None:
        margin = scenario.crowd.robot_response.margin if scenario.crowd else 0.0
        system = CrowdSystem(engine, body.push, model, margin, tick)
        crowd = builder.AddNamedSystem("crowd", system)
        builder.Connect(robot_state, crowd.GetInputPort(ports.ROBOT_STATE))
        if body.push_port is not None:
            builder.Connect(crowd.GetOutputPort(ports.ROBOT_FORCE), body.push_port)
        size = crowd_state.size(len(engine.agents))

    # Sensors, odometry among them.
    scene = _scene(scenario, parts, engine)
    built = {n: build_sensor(registry, x) for n, x in robot.sensors.items() if n in sensors}
    bank = builder.AddNamedSystem(
        "sensors",
        SensorBank(
            built,
            scene,
            size,
            seed=run_seed,
            robot=robot_name,
            on_reading=log.writer.reading,
            on_photograph=log.writer.photograph if log.writer.images else None,
            painters=_painters({n: x.info() for n, x in built.items()}, scene),
        ),
    )
    builder.Connect(robot_state, bank.GetInputPort(ports.ROBOT_STATE))

    # Planner, slew limits, control mode.
    def on_step(t: float, hosted: HostedCommand) -> None:
        log.command(t, hosted.command, hosted.seconds, hosted.clamped)

    planner = builder.AddNamedSystem(
        "planner",
        PlannerSystem(
            host, bank, body, model.limits, task,
            rate=scenario.rates.planner, visible=dict.fromkeys(visible),
            on_step=on_step, on_signal=log.writer.signal,
            people=_people(engine) if privileged else None,
        ),
    )  # fmt: skip
    if privileged:
        builder.Connect(robot_state, planner.GetInputPort(ports.ROBOT_STATE))
        if crowd is not None and engine is not None and len(engine.agents):
            builder.Connect(
                crowd.GetOutputPort(ports.CROWD_STATE), planner.GetInputPort(ports.CROWD_STATE)
            )
    builder.Connect(bank.GetOutputPort(ports.READINGS), planner.GetInputPort(ports.READINGS))
    builder.Connect(planner.GetOutputPort(ports.DESIRED_STATE), body.desired)

    # Metric logger and recorder.
    walls = WallContacts(parts, model, log)
    logger = builder.AddNamedSystem(
        "metric_logger",
        MetricLogger(log, task, walls, size, scenario.rates.log, felt=body.rig is not None),
    )
    builder.Connect(robot_state, logger.GetInputPort(ports.ROBOT_STATE))
    if body.rig is not None:
        forces = body.rig.plant.get_contact_results_output_port()
        builder.Connect(forces, logger.GetInputPort(ports.FORCES))
    builder.AddNamedSystem("recorder", Recorder(log.writer))
    if crowd is not None:
        for block in (bank, logger):
            builder.Connect(
                crowd.GetOutputPort(ports.CROWD_STATE), block.GetInputPort(ports.CROWD_STATE)
            )
        builder.Connect(crowd.GetOutputPort(ports.EVENTS), logger.GetInputPort(ports.EVENTS))

    return Blocks(
        diagram=builder.Build(),
        robot=body,
        bank=bank,
        planner=planner,
        logger=logger,
        walls=walls,
        crowd=crowd,
    )


def _people(engine: CrowdEngine | None) -> People:
    if engine is None:
        return People(np.zeros(0, np.int64), np.zeros(0))
    return People(engine.agents.id, engine.agents.radius)


def _painters(sensors: Mapping[str, SensorInfo], scene: Scene) -> dict[str, Painter]:
    """What draws the pictures of cameras with colour; VTK is loaded for these only."""
    cameras = {n: i for n, i in sensors.items() if i.camera is not None and i.camera.colour}
    if not cameras:
        return {}
    from crowdbot.core.sim.rendering import Renderer

    return {n: Renderer(scene, i.camera, i.mount) for n, i in cameras.items() if i.camera}


def _scene(scenario: Scenario, parts: EnvironmentParts, engine: CrowdEngine | None) -> Scene:
    count = 0 if engine is None else len(engine.agents)
    radius = np.zeros(0) if engine is None else engine.agents.radius
    height = scenario.crowd.body.height if scenario.crowd else 0.0
    return Scene(
        parts.walls, parts.wall_heights, radius, np.full(count, height),
        parts.pillars, parts.pillar_heights,
    )  # fmt: skip
