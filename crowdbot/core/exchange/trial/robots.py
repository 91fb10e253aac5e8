"""Robots of a trial: the model found by its mesh, the sensors of its prefab, a goal."""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from crowdbot.core.exchange.formats import Context
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Data, Draft, free_name, name_of
from crowdbot.core.exchange.trial.law import Motion, heading, place, read_law
from crowdbot.core.robots.build import build_model
from crowdbot.core.scenarios.plugin_folders import plugin_folders
from crowdbot.dsl.text.diagnostics import Source
from crowdbot.dsl.text.nodes import parse, to_data

#: Beginning of a mesh's name, in lower case -> our kind.
KINDS: Mapping[str, str] = {
    "pepper": "pepper", "wheelchair": "smart_wheelchair", "smartwheelchair": "smart_wheelchair",
    "qolo": "qolo", "cuybot": "cuybot", "turtlebot": "turtlebot2",
}  # fmt: skip
ROBOT = RowTable(
    "TrialRegularRobot",
    (
        Row("@mesh", "robots.model", "the robot of ours with this name"),
        Row("@radius", "crowd.robot_response.margin", "less the body's own radius"),
        Row("@in_sim", "crowd.robot_response.reaction", "false: people ignore the robot"),
        Row("Position", "robots.task.start"),
        Row("Rotation", "robots.task.start"),
        Row("controlLaw", "robots.task.goal", "the last goal of the law; a planner drives there"),
        Row("controlSim", "", "a planner drives the robot, not a crowd simulation"),
    ),
)
#: Side of a goal zone, and how far ahead it lies where nothing says where to, m.
_SIDE, _AHEAD = 1.0, (5.0, 3.0, 8.0, 2.0, 12.0)
_ANY = "its name is not known: a TurtleBot2"


def read_robots(root: Item | None, scene: Draft, context: Context) -> None:
    """Add all robots to a scene.

    Raises:
        SpecError: E402, a value is invalid.
    """
    margins, seen = [], []
    for wrapper in root.every("robot") if root else []:
        for item in wrapper.every("TrialRegularRobot"):
            margin, in_sim = _read(item, scene, context)
            margins.append(margin)
            seen.append(in_sim)
    if margins:
        response: Data = {"margin": round(max(margins), 9), "velocity": "hidden",
                          "shown_to_policies": True}  # fmt: skip
        scene.crowd["robot_response"] = response if any(seen) else {"reaction": "ignore"}
        if len(set(margins)) > 1 or len(set(seen)) > 1:
            note = "common to all robots: the largest margin, seen if any is"
            context.report.added("crowd.robot_response", note, root.mark if root else None)
        note = "the original never tells its crowd how the robot moves"
        context.report.added("crowd.robot_response.velocity", note)


def _read(item: Item, scene: Draft, context: Context) -> tuple[float, bool]:
    report = context.report
    mesh = item.need("@mesh")
    kind = next((k for n, k in KINDS.items() if mesh.text().lower().startswith(n)), "")
    report.interpreted(mesh, "robots.model", ROBOT.rows[0].note if kind else _ANY)
    robot = _part(kind or "turtlebot2", context)
    start = place(item.need("Position"), report)
    facing = heading(item.need("Rotation"))
    report.carried(item.need("Rotation"), "robots.task.start")
    motion = _law(item, start, facing, report)
    if (sim := item.find("controlSim")) is not None:
        report.left_out(sim, ROBOT.rows[-1].note)
    name = free_name(name_of(mesh.text()), scene.robots)
    zone = _zone(motion, start, facing, scene, context)
    free = scene.part("zones", f"{name}_goal", zone, item.mark)
    robot["task"] = {"start": [*start, facing], "goal": {"zone": free}}
    scene.robots[name] = robot
    scene.origins["robots", name] = item.mark
    return _margin(item, robot["model"]["kind"], context), _in_sim(item, context)


def _law(item: Item, start: list[float], facing: float, report: Report) -> Motion:
    """Return the motion of a robot's law, of which the last goal alone counts."""
    motion = read_law(item.find("controlLaw"), start, facing, Report())
    law = motion.item
    if law is None:
        return motion
    note = ROBOT.rows[5].note if motion.walks else "a planner drives the robot"
    report.interpreted(law, ROBOT.rows[5].ours, note)
    parts = [part for part in law.walk() if part.used and part is not law]
    goals = [part for part in parts if part.name in ("Goal", "Waypoint")]
    for part in parts:
        if goals and part is goals[-1]:
            report.carried(part, "robots.task.goal")
        elif part in goals or (part.parent is law and not part.children):
            report.left_out(part, "a planner drives the robot to the last goal")
    return motion


def _margin(item: Item, kind: str, context: Context) -> float:
    radius = item.find("@radius")
    model = build_model(context.registry, context.registry.find("robot", kind).spec(kind=kind))
    if radius is None:
        return 0.25
    context.report.interpreted(radius, ROBOT.rows[1].ours, ROBOT.rows[1].note)
    return max(0.0, radius.number(0.0, 100.0) - model.footprint_radius)


def _in_sim(item: Item, context: Context) -> bool:
    given = item.find("@in_sim")
    if given is None:
        return True
    context.report.carried(given, ROBOT.rows[2].ours)
    return given.truth()


def _part(kind: str, context: Context) -> Data:
    """Return a robot with the sensors of its packaged part."""
    for folder in plugin_folders(context.registry)["builtin"]:
        file = folder / "parts" / f"{kind}.yaml"
        if file.is_file():
            text = file.read_text(encoding="utf-8")
            data: Any = to_data(parse(text, Source(file.name), []))
            robot: Data = deepcopy(data["robots"]["robot"])
            return {name: robot[name] for name in ("model", "control", "sensors")}
    return {"model": {"kind": kind}}


def _zone(
    motion: Motion, start: list[float], facing: float, scene: Draft, context: Context
) -> Data:
    """Return the goal zone: round the law's last goal, or a few metres ahead."""
    if motion.walks:
        return _square(*motion.goals[-1])
    ways = [(far, facing + turn) for turn in (0.0, math.pi, math.pi / 2, -math.pi / 2)
            for far in _AHEAD]  # fmt: skip
    points = [(start[0] + d * math.cos(a), start[1] + d * math.sin(a)) for d, a in ways]
    free = [p for p in points if _is_free(p, start, scene)]
    note = "the trial says no goal, since something outside drives the robot: a zone ahead of it"
    context.report.added("robots.task.goal", note, motion.item.mark if motion.item else None)
    return _square(*(free or points)[0])


def _square(x: float, y: float) -> Data:
    half = 0.5 * _SIDE
    return {"x": [round(x - half, 6), round(x + half, 6)],
            "y": [round(y - half, 6), round(y + half, 6)]}  # fmt: skip


def _is_free(point: tuple[float, float], start: list[float], scene: Draft) -> bool:
    """Return True if the straight way to a point keeps a metre off all walls and blocks."""
    env = scene.environment
    area = env.get("area")
    if area and not (area["x"][0] + 1 < point[0] < area["x"][1] - 1
                     and area["y"][0] + 1 < point[1] < area["y"][1] - 1):  # fmt: skip
        return False
    solid = [_bounds([w["start"], w["end"]]) for w in env.get("walls", {}).values()]
    solid += [_bounds(b["corners"]) for b in env.get("blocks", {}).values()]
    steps = [k / 40.0 for k in range(4, 41)]
    way = [(start[0] + s * (point[0] - start[0]), start[1] + s * (point[1] - start[1]))
           for s in steps]  # fmt: skip
    return not any(
        x0 - 0.8 < x < x1 + 0.8 and y0 - 0.8 < y < y1 + 0.8
        for x, y in way for x0, x1, y0, y1 in solid
    )  # fmt: skip


def _bounds(points: list[list[float]]) -> tuple[float, float, float, float]:
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    return min(xs), max(xs), min(ys), max(ys)
