"""The stage of a trial: a known scene of the original, or its obstacles."""

from __future__ import annotations

from copy import deepcopy

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.polygons import add_wall
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft
from crowdbot.core.exchange.trial.stages import STAGES

SCENE = RowTable(
    "scene",
    (
        Row("@meshName", "environment", "by what is known of the original's scenes"),
        Row("Position", "", "a point of the stage for the generator; nothing is there"),
        Row("Rotation", "", "a turn of that point"),
        Row("recordingFile", "", "each run records itself: crowdbot simulate --out"),
        Row("endingConditions/condition", "robots.task"),
    ),
)
OBSTACLES = RowTable(
    "obstacles",
    (
        Row("obstacle/TrialObstacle/Lines/Line", "environment.walls",
            "raw Unity x and z; the original writes turned walls wrong"),
        Row("obstacle/TrialObstacle/Points/Point", "environment.pillars", "raw Unity x and z"),
    ),
)  # fmt: skip
_KNOWN = "the stage is known, and the original writes turned walls wrong and never reads them back"


def read_stage(
    scene_item: Item | None, obstacles: Item | None, scene: Draft, report: Report
) -> None:
    """Set the environment of a scene.

    Raises:
        SpecError: E402, a value is invalid.
    """
    name = scene_item.find("@meshName") if scene_item else None
    stage = STAGES.get(name.text()) if name else None
    if name is not None and scene_item is not None:
        scene.origins["environment",] = name.mark
        _named(name, stage[1] if stage else None, report)
        for part, row in (("Position", SCENE.rows[1]), ("Rotation", SCENE.rows[2])):
            if (item := scene_item.find(part)) is not None:
                report.left_out(item, row.note)
        if (item := scene_item.find("recordingFile")) is not None:
            report.left_out(item, SCENE.rows[3].note)
    if stage is not None:
        scene.environment = deepcopy(stage[0])
        if obstacles is not None and obstacles.children:
            report.left_out(obstacles, _KNOWN)
    elif obstacles is not None:
        _read_obstacles(obstacles, scene, report)


def _named(name: Item, known: str | None, report: Report) -> None:
    if known == "":
        report.carried(name, "environment")
    elif known is not None:
        report.interpreted(name, "environment", known)
    else:
        note = "no stage of this name is known: an open floor with the trial's obstacles"
        report.interpreted(name, "environment", note)


def _read_obstacles(root: Item, scene: Draft, report: Report) -> None:
    for wrapper in root.every("obstacle"):
        for obstacle in wrapper.every("TrialObstacle"):
            for lines in obstacle.every("Lines"):
                for line in lines.every("Line"):
                    _line(line, scene, report)
            for points in obstacle.every("Points"):
                for point in points.every("Point"):
                    _point(point, scene, report)


def _line(item: Item, scene: Draft, report: Report) -> None:
    x1, z1, x2, z2 = (item.need(f"@{name}").number() for name in ("x1", "y1", "x2", "y2"))
    report.interpreted(item, "environment.walls", OBSTACLES.rows[0].note)
    add_wall(scene, item, [z1, -x1 + 0.0], [z2, -x2 + 0.0], _thickness(item))


def _point(item: Item, scene: Draft, report: Report) -> None:
    x, z = item.need("@x1").number(), item.need("@y1").number()
    pillar = {"x": z, "y": -x + 0.0, "radius": 0.5 * _thickness(item)}
    report.interpreted(item, "environment.pillars", OBSTACLES.rows[1].note)
    scene.part("pillars", "pillar", pillar, item.mark)


def _thickness(item: Item) -> float:
    found = item.find("@thickness")
    return max(found.number(0.0, 1000.0), 0.01) if found else 0.1
