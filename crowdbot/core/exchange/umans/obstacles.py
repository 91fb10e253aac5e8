"""Obstacles of UMANS as blocks of a floor; those without an area as thin walls."""

from __future__ import annotations

from crowdbot.core.exchange.item import Item
from crowdbot.core.exchange.polygons import add_polygon
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.rows import Row, RowTable
from crowdbot.core.exchange.scene import Draft
from crowdbot.core.exchange.umans.agents import point

OBSTACLES = RowTable(
    "Obstacles",
    (
        Row("Obstacle/Point", "environment.blocks.corners"),
        Row("Obstacle without area", "environment.walls", "walls 2 cm thick along its points"),
    ),
)


def read_obstacles(root: Item, scene: Draft, report: Report) -> None:
    """Add all polygons of an ``Obstacles`` element to a scene.

    Raises:
        SpecError: E402, a point is not one.
    """
    for item in root.every("Obstacle"):
        points = item.every("Point")
        corners = [point(p) for p in points]
        for p in points:
            report.carried(p, "environment.blocks")
        add_polygon(scene, report, item, corners)
