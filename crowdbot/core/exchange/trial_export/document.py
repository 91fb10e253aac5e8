"""A whole trial: stage, player, robots, people and obstacles."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree as Xml

from crowdbot.core.environments.build import build_environment
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.trial.robots import KINDS
from crowdbot.core.exchange.trial.stages import STAGES
from crowdbot.core.exchange.trial_export.elements import add, number, place, text_of, turn
from crowdbot.core.exchange.trial_export.lost import name_lost
from crowdbot.core.exchange.trial_export.people import add_people
from crowdbot.core.registry.registry import Registry
from crowdbot.core.robots.build import build_model
from crowdbot.core.scenarios.lock import population
from crowdbot.dsl.scenario.robot import Robot
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.errors import InputError

_MESHES: Mapping[str, str] = {
    "pepper": "Pepper", "smart_wheelchair": "Wheelchair", "qolo": "Qolo", "cuybot": "CuyBot",
    "turtlebot2": "turtlebot",
}  # fmt: skip
#: Thickness of the sides of blocks and of the border, m.
_THIN = 0.02
assert set(_MESHES) == set(KINDS.values())


@dataclass(frozen=True, slots=True)
class TrialDocument:
    """A scenario exported as a trial: XML, policies and report.

    Attributes:
        text: the trial XML.
        policies: file of policies of UMANS; empty if the original's presets suffice.
        report: what a trial cannot express.
    """

    text: str
    policies: str
    report: Report


def export_trial(scenario: Scenario, registry: Registry) -> TrialDocument:
    """Return a scenario as a trial of the original."""
    report, root = Report(), Xml.Element("Trial")
    _scene(root, scenario, report)
    robots = add(root, "robots")
    for name, robot in scenario.robots.items():
        _robot(robots, name, robot, scenario, registry, report)
    agents = add(root, "agents")
    policies = ""
    if scenario.crowd is not None:
        people = population(scenario, registry).agents
        policies = add_people(agents, scenario, people, registry, report)
    _obstacles(root, scenario, registry, report)
    _rest(scenario, report)
    name_lost(scenario, report)
    return TrialDocument(text_of(root), policies, report)


def _scene(root: Xml.Element, scenario: Scenario, report: Report) -> None:
    stage = _stage(scenario)
    scene = add(root, "scene", meshName=stage or "Imported")
    place(scene, "Position", 0.0, 0.0)
    turn(scene, 0.0)
    add(scene, "recordingFile").text = "Output_{USER}_{ITT}.csv"
    endings = add(scene, "endingConditions")
    limits = [robot.task.time_limit for robot in scenario.robots.values()]
    if limits:
        add(endings, "condition", parameter="time", test="greater", value=number(min(limits)))
    else:
        add(endings, "condition", parameter="time", test="less", value="0")
    if not stage:
        note = "no scene of the original is like it: its walls and pillars are obstacles of the "
        report.added("scene", f"{note}trial, which the original does not read back")
    player = add(add(root, "player"), "TrialCamPlayer", mesh="CamPlayer", radius="0.33",
                 in_sim="false")  # fmt: skip
    place(player, "Position", -10.0, 0.0, 12.0)
    add(player, "Rotation", x="-45", y="0", z="0")
    add(add(player, "controlLaw"), "LawCamControlEditor", lookSpeedH="2", lookSpeedV="2",
        zoomSpeed="8", dragSpeed="12")  # fmt: skip


def _stage(scenario: Scenario) -> str:
    """Return the name of the original's scene with these walls; empty if there is none."""
    env = scenario.environment.model_dump(mode="json")
    solid = ("walls", "blocks", "pillars")
    for name, (data, _) in STAGES.items():
        alike = all(_plain(env.get(n) or {}) == _plain(data.get(n, {})) for n in solid)
        border = env.get("border") == data["border"]
        walls = any(data.get(n) for n in solid)
        same = scenario.environment.kind == data["kind"] and alike and border
        if same and (walls or data["border"] == "open"):
            return name
    return ""


def _plain(parts: Any) -> Any:
    """Return parts with numbers as floats, without null and default values."""
    if isinstance(parts, Mapping):
        return {k: _plain(v) for k, v in parts.items() if v not in (None, 0.0, [], ())}
    if isinstance(parts, list | tuple):
        return [_plain(v) for v in parts]
    return float(parts) if isinstance(parts, int | float) else parts


def _robot(
    root: Xml.Element, name: str, robot: Robot, scenario: Scenario, registry: Registry,
    report: Report,
) -> None:  # fmt: skip
    kind, response = robot.model.kind, scenario.crowd.robot_response if scenario.crowd else None
    if kind not in _MESHES:
        report.added("robots", f"{name}: {kind} is not a robot of the original: its turtlebot")
    model = build_model(registry, robot.model)
    margin = response.margin if response else 0.25
    ignored = response is not None and response.ignoring >= 1.0
    element = add(
        add(root, "robot"), "TrialRegularRobot", mesh=_MESHES.get(kind, "turtlebot"),
        radius=number(round(model.footprint_radius + margin, 9)),
        in_sim="false" if ignored else "true",
    )  # fmt: skip
    x, y, heading = robot.task.start
    place(element, "Position", x, y)
    turn(element, heading)
    if robot.task.zone is None:
        raise InputError(
            f"{scenario.id}: the goal of robot '{name}' is a person, which a trial cannot say"
        )
    zone = scenario.environment.zones[robot.task.zone]
    law = add(
        add(element, "controlLaw"), "LawGoals", speedCurrent="0", speedDefault="1.33",
        accelerationMax="0.8", angularSpeed="36000", reachedDist="0.5", isLooping="false",
    )  # fmt: skip
    place(add(law, "Goals"), "Goal", 0.5 * sum(zone.x), 0.5 * sum(zone.y))
    sides = (zone.x[1] - zone.x[0], zone.y[1] - zone.y[0])
    if not all(math.isclose(side, 1.0, abs_tol=1e-6) for side in sides):
        report.added("robots", f"{name}: its goal is the middle of the zone, 1 m wide there")
    report.added("robots", f"{name}: its sensors are those of the original's own robot")


def _obstacles(root: Xml.Element, scenario: Scenario, registry: Registry, report: Report) -> None:
    obstacles, floor = add(root, "obstacles"), scenario.environment
    if _stage(scenario):
        return
    whole: Mapping[str, Any] = getattr(floor, "walls", {}) if floor.kind == "floor" else {}
    for wall in whole.values():
        _line(obstacles, (*wall.start, *wall.end), wall.thickness)
    rest = floor.model_copy(update={"walls": {}}) if whole else floor
    parts = build_environment(registry, rest)
    for side in parts.walls.tolist():
        _line(obstacles, side, _THIN)
    for x, y, radius in parts.pillars[:, :3].tolist():
        obstacle = add(add(obstacles, "obstacle"), "TrialObstacle")
        add(add(obstacle, "Points"), "Point", x1=number(-y), y1=number(x),
            thickness=number(2.0 * radius))  # fmt: skip
    if len(parts.walls):
        report.added("obstacles", f"{len(parts.walls)} sides of blocks and the border, one by one")
    if any(wall.height is not None for wall in whole.values()):
        report.added("environment.walls.height", "left out: a trial's obstacles have none")


def _line(root: Xml.Element, ends: Sequence[float], thickness: float) -> None:
    """Append a straight wall between two points of crowdbot's scenario, m."""
    x1, y1, x2, y2 = ends
    lines = add(add(add(root, "obstacle"), "TrialObstacle"), "Lines")
    add(lines, "Line", x1=number(-y1), y1=number(x1), x2=number(-y2), y2=number(x2),
        thickness=number(thickness))  # fmt: skip


def _rest(scenario: Scenario, report: Report) -> None:
    if scenario.environment.portals:
        report.added("environment.portals", "left out: trials have none")
    report.added("rates", "left out: a trial does not say how often people decide")
    if scenario.robots:
        report.added("contact", "left out: a trial does not say how soft bodies are")
