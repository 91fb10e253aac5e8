"""CommonRoad: pedestrians of a scenario as recorded people, solid obstacles as blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence

from crowdbot.core.exchange.formats import Context, SceneFormat
from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.opened import OpenedScene
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft, around, id_of
from crowdbot.core.exchange.trial.replays import HEADER

SCENARIO = RowTable(
    "commonRoad",
    (
        Row("@timeStepSize", "crowd.policy replay.file", "time of each state"),
        Row("dynamicObstacle pedestrian", "crowd.policy replay.file", "walks as recorded"),
        Row("dynamicObstacle of another type", "", "there are no vehicles"),
        Row("staticObstacle", "environment.blocks", "its outline at its place"),
        Row("lanelet, trafficSign, trafficLight, intersection", "", "people walk anywhere"),
        Row("planningProblem", "", "it is of a vehicle"),
        Row("location, scenarioTags", "", "for people"),
    ),
)
_PERSON = "pedestrian"
Point = tuple[float, float, float]


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
    rows: list[tuple[float, int, float, float]] = []
    for item in root.every("dynamicObstacle", "obstacle"):
        kind = item.need("type").text().lower()
        if kind != _PERSON:
            report.left_out(item, SCENARIO.rows[2].note)
            continue
        ident = item.need("@id").whole(0)
        rows += [(t, ident, x, y) for t, x, y in _states(item, dt)]
        report.interpreted(item, "crowd.policy replay.file", SCENARIO.rows[1].note)
        for part in item.children:
            part.take_all()
    if not rows:
        root.refuse("no dynamicObstacle is a pedestrian: nothing to import")
    for item in root.every("staticObstacle"):
        _static(item, scene, report)
    for name in ("lanelet", "trafficSign", "trafficLight", "intersection"):
        for item in root.every(name):
            report.left_out(item, SCENARIO.rows[4].note)
    for name, row in (("planningProblem", 5), ("location", 6), ("scenarioTags", 6)):
        for item in root.every(name):
            report.left_out(item, SCENARIO.rows[row].note)
    for item in root.children:
        if item.name.startswith("@") and not item.used:
            report.left_out(item, SCENARIO.rows[6].note)
    _record(rows, scene, root, context)
    return scene


def _record(
    rows: list[tuple[float, int, float, float]], scene: Draft, root: Item, context: Context
) -> None:
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


def _states(item: Item, dt: float) -> list[Point]:
    states = [item.need("initialState")]
    trajectory = item.find("trajectory")
    states += trajectory.every("state") if trajectory else []
    found: list[Point] = []
    for state in states:
        time = _exact(state.need("time")) * dt
        point = state.need("position").need("point")
        if found and time <= found[-1][0]:
            state.refuse("the times of a person have to rise")
        found.append((time, point.need("x").number(), point.need("y").number()))
    if len(found) == 1:  # stands
        found.append((found[0][0] + 1.0, *found[0][1:]))
    return found


def _exact(item: Item) -> float:
    exact = item.find("exact")
    if exact is None:
        low, high = item.need("intervalStart").number(), item.need("intervalEnd").number()
        return 0.5 * (low + high)
    return exact.number()


def _static(item: Item, scene: Draft, report: Report) -> None:
    state = item.need("initialState")
    point = state.need("position").need("point")
    turn = state.find("orientation")
    angle = _exact(turn) if turn else 0.0
    x, y = point.need("x").number(), point.need("y").number()
    shape = item.need("shape")
    if (circle := shape.find("circle")) is not None:
        pillar = {"x": x, "y": y, "radius": circle.need("radius").number(1e-3)}
        scene.part("pillars", "static", pillar, item.mark)
    else:
        corners = [[x + u * math.cos(angle) - v * math.sin(angle),
                    y + u * math.sin(angle) + v * math.cos(angle)]
                   for u, v in _outline(shape)]  # fmt: skip
        scene.part("blocks", "static", {"corners": corners}, item.mark)
    report.interpreted(item, "environment.blocks", SCENARIO.rows[3].note)
    item.take_all()


def _outline(shape: Item) -> list[tuple[float, float]]:
    rectangle = shape.find("rectangle")
    if rectangle is not None:
        a = 0.5 * rectangle.need("length").number(1e-3)
        b = 0.5 * rectangle.need("width").number(1e-3)
        return [(-a, -b), (a, -b), (a, b), (-a, b)]
    points = shape.need("polygon").every("point")
    return [(p.need("x").number(), p.need("y").number()) for p in points]


COMMONROAD = SceneFormat(
    "commonroad",
    "CommonRoad scenarios",
    lambda file: file.kind == "xml" and "commonRoad" in file.tags,
    read,
    (SCENARIO,),
    "roads, vehicles, planning problems",
)
