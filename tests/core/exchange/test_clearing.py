"""People, goals and areas in something solid are moved out of it, and named."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from shapely import box  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.exchange.clearing import FreeFloor, step_out
from crowdbot.core.exchange.report import Report
from crowdbot.core.exchange.scene import Draft
from crowdbot.dsl.text.diagnostics import Mark, Source
from tests.core.exchange.importing import document_of, imported, notes

_AGENTS = """<Agents>
  <Agent rad="0.3"><pos x="1.1" y="0"/><goal x="0.5" y="0"/><Policy id="0"/></Agent>
  <Agent rad="0.3"><pos x="5" y="0"/><goal x="-5" y="0"/><Policy id="0"/></Agent>
</Agents>"""
_POLICY = '<Policies><Policy id="0"><costfunction name="RVO"/></Policy></Policies>'
_BLOCK = """<Obstacles><Obstacle><Point x="-1" y="-1"/><Point x="1" y="-1"/><Point x="1" y="1"/>
<Point x="-1" y="1"/></Obstacle></Obstacles>"""


def _people(folder: Path) -> tuple[list[dict[str, Any]], dict[str, str]]:
    files = []
    for name, text in (("a", _AGENTS), ("p", _POLICY), ("o", _BLOCK)):
        files.append(folder / f"{name}.xml")
        files[-1].write_text(text)
    found = imported(*files)
    return document_of(found)["scenario"]["crowd"]["agents"], notes(found, "interpreted")


def test_people_and_goals_in_an_obstacle_are_moved_out_of_it(tmp_path: Path) -> None:
    (inside, free), reasons = _people(tmp_path)
    assert math.isclose(inside["x"], 1.31, abs_tol=2e-3)
    assert inside["y"] == 0
    assert inside["goals"][0][0] > 1.0
    assert (free["x"], free["goals"]) == (5, [[-5, 0]])
    assert "moved 0.21 m" in reasons["start"]
    assert "out of it" in reasons["goal 0"]


def test_blocks_beyond_a_border_are_cut_off() -> None:
    scene = Draft()
    scene.environment |= {"border": "walls", "area": {"x": [0, 10], "y": [0, 5]}}
    mark, report = Mark(Source("here")), Report()
    for corners in ([[8, 0], [12, 0], [12, 2], [8, 2]], [[20, 0], [21, 0], [21, 1]]):
        scene.part("blocks", "obstacle", {"corners": corners}, mark)
    scene.crowd["streams"] = {"in": {"origin": {"centre": [-0.5, 2.5], "size": [2.0, 1.0]}}}
    step_out(scene, report)
    (block,) = scene.environment["blocks"].values()
    assert max(x for x, _ in block["corners"]) == 10
    assert scene.crowd["streams"]["in"]["origin"]["centre"] == [0.25, 2.5]
    entries = [entry.note for entry in report.entries]
    assert len([note for note in entries if "outside of the floor" in note]) == 3


def test_a_wall_across_the_floor_parts_it() -> None:
    scene = Draft()
    scene.environment |= {"border": "walls", "area": {"x": [0, 10], "y": [0, 5]}}
    scene.environment["walls"] = {"w": {"start": [5, 0], "end": [5, 4.5], "thickness": 0.1}}
    floor, west, east = FreeFloor(scene), box(1, 1, 2, 2), box(8, 1, 9, 2)
    assert floor.joins(west, east, 0.2)
    assert not floor.joins(west, east, 0.3)
