"""CommonRoad: pedestrians of a scenario as recorded people, solid obstacles as blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.polygons import add_polygon
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft, around, id_of
from crowdbot.core.exchange.trial.replays import HEADER

SCENARIO = RowTable(
    "commonRoad",
    (
        Row("@timeStepSize", "crowd.policy replay.file", "time of each state"),
        Row(
            "dynamicObstacle pedestrian",
            "crowd.policy replay.file",
            "walks as recorded; an uncertain place is its middle",
        ),
        Row("dynamicObstacle of another type", "", "there are no vehicles"),
        Row(
            "staticObstacle, environmentObstacle", "environment.blocks", "its outline at its place"
        ),
        Row("dynamicObstacle pedestrian shape", "crowd.body.radius", "the widest of all"),
        Row("lanelet, trafficSign, trafficLight, intersection", "", "people walk anywhere"),
        Row("planningProblem", "", "it is of a vehicle"),
        Row("location, scenarioTags", "", "for people"),
        Row("orientation, velocity, acceleration", "", "they follow from the places"),
        Row("signalState, signalSeries", "", "people have no lights"),
        Row("staticObstacle type, initialState.time", "", "all are solid, and all the time"),
    ),
)
_PERSON = "pedestrian"
_SIGNALS = ("initialSignalState", "signalSeries")
_SIZES = ("length", "width", "radius", "orientation")
#: Parts of a state beside its place and time.
_OF_MOTION = ("orientation", "velocity", "acceleration", "yawRate", "slipAngle", "steeringAngle",
              "velocityY", "accelerationY", "positionZ", "rollAngle", "rollRate", "pitchAngle",
              "pitchRate", "jerk", "curvature")  # fmt: skip
Point = tuple[float, float, float]
#: Time, s, number, x and y, m.
Recorded = tuple[float, int, float, float]


def read(files: Sequence[OpenedScene], context: Context) -> list[Draft]:
    """Return one scene for each file.

    Raises:
        SpecError: E402, there is no pedestrian, or a state is incomplete.
    """
    return [_scene(file, root, context) for file in files for root in file.roots]


def _scene(file: OpenedScene, root: Item, context: Context) -> Draft:
    report, scene = context.report, Draft(id_of(file.path.stem))
    scene.notes.append(f"Imported from CommonRoad: {file.path.name}.")
    step = root.find("@timeStepSize")
    dt = step.number(1e-6, 1e3) if step else 0.1
    rows: list[Recorded] = []
    radii: list[float] = []
    for item in root.every("dynamicObstacle", "obstacle"):
        role = item.find("role")
        if role is not None and role.word("static", "dynamic") == "static":
            _static(item, scene, report)
        else:
            found = _pedestrian(item, dt, report)
            rows += found[0]
            radii += found[1]
    if not rows:
        root.refuse("no dynamicObstacle is a pedestrian: nothing to import")
    if radii:
        scene.crowd["body"] = {"radius": max(0.05, round(max(radii), 6))}
    for item in root.every("staticObstacle", "environmentObstacle"):
        _static(item, scene, report)
    for name in ("lanelet", "trafficSign", "trafficLight", "intersection"):
        for item in root.every(name):
            report.left_out(item, SCENARIO.rows[5].note)
    for name, row in (("planningProblem", 6), ("location", 7), ("scenarioTags", 7)):
        for item in root.every(name):
            report.left_out(item, SCENARIO.rows[row].note)
    for item in root.children:
        if item.name.startswith("@") and not item.used:
            report.left_out(item, SCENARIO.rows[7].note)
    _record(rows, scene, root, context)
    return scene


def _pedestrian(item: Item, dt: float, report: Report) -> tuple[list[Recorded], list[float]]:
    """Return the states of a person and its radius, m; nothing for other obstacles."""
    if item.need("type").text().lower() != _PERSON:
        report.left_out(item, SCENARIO.rows[2].note)
        return [], []
    ident = item.need("@id").whole(0)
    rows = [(t, ident, x, y) for t, x, y in _states(item, dt, report)]
    report.interpreted(item, "crowd.policy replay.file", SCENARIO.rows[1].note)
    radii = _radius(item, report)
    report.others(item, SCENARIO.rows[9].note, *_SIGNALS)
    return rows, radii


def _record(rows: list[Recorded], scene: Draft, root: Item, context: Context) -> None:
    table = f"{context.name}.{scene.id}.csv"
    scene.tables[table] = HEADER + "".join(
        f"{t!r},{i},{x!r},{y!r}\n" for t, i, x, y in sorted(rows)
    )
    xs, ys = [row[2] for row in rows], [row[3] for row in rows]
    for block in scene.environment.get("blocks", {}).values():
        xs += [c[0] for c in block["corners"]]
        ys += [c[1] for c in block["corners"]]
    scene.environment["area"] = around(min(xs), max(xs), min(ys), max(ys))
    scene.policy({"policy": {"kind": "replay", "file": table}, "costs": {}}, "replay", root.mark)


def _states(item: Item, dt: float, report: Report) -> list[Point]:
    states = [item.need("initialState")]
    trajectory, occupied = item.find("trajectory"), item.find("occupancySet")
    states += trajectory.every("state") if trajectory else []
    if trajectory is None and occupied is not None:
        states += occupied.every("occupancy")
    points: list[Point] = []
    for state in states:
        time = _exact(state.need("time")) * dt
        shape = state.find("position") or state.need("shape")
        x, y = _middle(shape, report)
        report.others(state, SCENARIO.rows[8].note, *_OF_MOTION)
        if points and time == points[-1][0]:  # the first occupancy is the initial state
            continue
        if points and time < points[-1][0]:
            state.refuse("the times of a person have to rise")
        points.append((time, x, y))
    if len(points) == 1:  # stands
        points.append((points[0][0] + 1.0, *points[0][1:]))
    return points


def _middle(position: Item, report: Report) -> tuple[float, float]:
    """Return a point, or the middle of a region, m."""
    if (point := position.find("point")) is not None:
        return point.need("x").number(), point.need("y").number()
    for kind in ("rectangle", "circle"):
        if (region := position.find(kind)) is not None:
            centre = region.need("center")
            report.others(region, "an uncertain place is its middle", *_SIZES)
            return centre.need("x").number(), centre.need("y").number()
    corners = position.need("polygon").every("point")
    if not corners:
        position.refuse("a polygon without a point")
    xs = [p.need("x").number() for p in corners]
    ys = [p.need("y").number() for p in corners]
    return sum(xs) / len(xs), sum(ys) / len(ys)


def _exact(item: Item) -> float:
    exact = item.find("exact")
    if exact is None:
        low, high = item.need("intervalStart").number(), item.need("intervalEnd").number()
        return 0.5 * (low + high)
    return exact.number()


def _radius(item: Item, report: Report) -> list[float]:
    """Return the radius of a person's shape: half the width of one that is not a circle, m."""
    shape = item.find("shape")
    circle, rectangle = (shape.find(n) if shape else None for n in ("circle", "rectangle"))
    if shape is None or (circle is None and rectangle is None):
        return []
    report.interpreted(shape, "crowd.body.radius", SCENARIO.rows[4].note)
    for part in (circle, rectangle):
        if part is not None:
            report.others(part, "people are round, about their place", "center", "orientation")
    if circle is not None:
        return [circle.need("radius").number(1e-3, 10.0)]
    assert rectangle is not None
    return [0.5 * max(rectangle.need(n).number(1e-3, 20.0) for n in ("length", "width"))]


def _static(item: Item, scene: Draft, report: Report) -> None:
    state = item.find("initialState")
    x, y = _middle(state.need("position"), report) if state else (0.0, 0.0)
    turn = state.find("orientation") if state else None
    angle = _exact(turn) if turn else 0.0
    for shape in item.need("shape").elements():
        centre = shape.find("center")
        u, v = (centre.need(n).number() for n in ("x", "y")) if centre else (0.0, 0.0)
        at = (x + u * math.cos(angle) - v * math.sin(angle),
              y + u * math.sin(angle) + v * math.cos(angle))  # fmt: skip
        _solid(shape, (*at, angle), (x, y), scene, report)
    report.interpreted(item, "environment.blocks", SCENARIO.rows[3].note)
    for part in (item, *([state] if state else [])):
        report.others(part, SCENARIO.rows[10].note, "@id", "type", *_OF_MOTION, "time", *_SIGNALS)


def _solid(
    shape: Item, pose: Point, origin: tuple[float, float], scene: Draft, report: Report
) -> None:
    """Add one shape: at its own pose x, y, angle, or a polygon about the origin."""
    x, y, angle = pose
    if shape.name == "circle":
        pillar = {"x": x, "y": y, "radius": shape.need("radius").number(1e-3)}
        scene.part("pillars", "static", pillar, shape.mark)
        return
    if shape.name == "rectangle":
        a, b = (0.5 * shape.need(n).number(1e-3) for n in ("length", "width"))
        own = shape.find("orientation")
        outline = [(-a, -b), (a, -b), (a, b), (-a, b)]
        turn, at = angle + (own.number() if own else 0.0), (x, y)
    elif shape.name == "polygon":
        corners = shape.every("point")
        outline = [(p.need("x").number(), p.need("y").number()) for p in corners]
        turn, at = angle, origin
    else:
        shape.refuse(f"no shape '{shape.name[:40]}'", ("circle", "rectangle", "polygon"))
    placed = [[at[0] + u * math.cos(turn) - v * math.sin(turn),
               at[1] + u * math.sin(turn) + v * math.cos(turn)] for u, v in outline]  # fmt: skip
    add_polygon(scene, report, shape, placed, name="static")


COMMONROAD = SceneFormat(
    "commonroad",
    "CommonRoad scenarios",
    lambda file: file.kind == "xml" and "commonRoad" in file.tags,
    read,
    (SCENARIO,),
    "roads, vehicles, planning problems",
)
