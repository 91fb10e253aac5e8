"""The replay page in three dimensions: each view is drawn, with what sensors and planner know."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import sync_playwright

from crowdbot.core.figures.figure import load_figure
from crowdbot.core.figures.shown import shown_figure
from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.replay.page import write_replay
from tests.browser import PROGRAM, Visit, needs_browser
from tests.core.figures.small_gltf import write
from tests.core.replay.replay_cases import passing
from tests.core.replay.test_browser import until

_SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_BOX = [[x, y, z] for x in (-0.2, 0.2) for y in (-0.2, 0.2) for z in (0.0, 0.6)]
_SOLIDS = {
    "walls": [[-1, -2, 6, -2, 0, 2, 3], [-1, 2, 6, 2, 0, 2, 3], [6, -2, 6, 2, 0, 2, 1]],
    "pillars": [[0.0, 1.2, 0.2, 0.0, 2.0]],
    "blocks": [[[[5.0, -1.8], [5.8, -1.8], [5.8, -1.2], [5.0, -1.2]], 0.0, 1.0]],
    "robots": [
        {
            "height": 0.6, "base": 0.0, "parts": [["#ff0000", _BOX], ["#00ff00", _BOX]],
            "cameras": [], "lidars": {"front": 0.2},
        }
    ],
    "people": {"height": [1.6, 1.8], "look": []},
}  # fmt: skip
_INFO = "shown.panels[0].solid.renderer.info.render"
_SIGNS = "shown.panels[0].solid.parts.signs.children.filter((sign) => sign.visible).length"
_LINES = "shown.panels[0].solid.parts.{}.geometry.drawRange.count"


@pytest.mark.slow
@needs_browser
def test_each_view_shows_people_robot_sensors_and_tracks(tmp_path: Path) -> None:
    track = np.array([[3.0, 1.0, 0.5, 0.1, 0.0]])
    times = [t / 4 for t in range(40)]
    drawn = {
        "tracks": [PlannerDrawing(t, track) for t in times],
        "points": [PlannerDrawing(t, np.array([[1.0, 0.0], [2.0, 0.0]])) for t in times],
        "arrows": [PlannerDrawing(t, np.zeros((4, 2))) for t in times],
        "why": [
            PlannerDrawing(t, np.array([[1.0, 0.0], [2.0, 0.0]]), ("", "waits")) for t in times
        ],
    }
    write_replay(tmp_path / "page.html", replace(passing(), solids=_SOLIDS, drawings=drawn))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=_SOFTWARE)
        with Visit(browser, tmp_path / "page.html", "#t=4") as page:
            page.evaluate("state.playing = false")
            for view in ("solid", "person", "camera"):
                before = page.evaluate("shown.panels[0].solid?.frames ?? 0")
                page.select_option("#view", view)
                until(page, f"(shown.panels[0].solid?.frames ?? 0) > {before}")
                assert (
                    page.evaluate(_LINES.format("thoughts")) == 8 + 8 + 4
                )  # a cross, a pole, its way; points; arrows
                assert page.evaluate(_LINES.format("points")) == 90
                assert page.evaluate(_SIGNS) == 1
                assert page.evaluate(_LINES.format("cones")) == 2 * 8
                assert page.evaluate(f"{_INFO}.triangles") > 200
            assert page.evaluate(f"{_INFO}.calls") < 20
            page.click("#lidar")
            until(page, _LINES.format("points") + " === 0")
            page.select_option("#view", "plan")
            assert page.is_visible(".closeup canvas")
        browser.close()


@pytest.mark.slow
@needs_browser
def test_figures_and_light_of_a_scenario_are_shown(tmp_path: Path) -> None:
    figure = shown_figure(load_figure(write(tmp_path / "a.glb", moves="node")))
    solids = {
        **_SOLIDS, "people": {"height": [1.7], "look": [], "figures": [figure]},
        "light": {"towards": [0.0, 1.0, 0.0], "sun": 0.5, "ambient": 1.0, "colour": "#ff8800",
                  "sky": "#102030"},
    }  # fmt: skip
    write_replay(tmp_path / "page.html", replace(passing(), solids=solids))
    drawn = "shown.panels[0].solid.parts.people"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=_SOFTWARE)
        with Visit(browser, tmp_path / "page.html", "#t=4") as page:
            page.evaluate("state.playing = false")
            page.select_option("#view", "solid")
            until(page, "(shown.panels[0].solid?.frames ?? 0) > 0")
            here = page.evaluate("shown.panels[0].frame?.people.size ?? shown.runs[0].people.count")
            figures = page.evaluate(
                f"{drawn}.figures[0].reduce((sum, mesh) => sum + mesh.count, 0)"
            )
            assert 1 <= figures <= here
            assert page.evaluate(f"{drawn}.bodies.reduce((n, b) => n + b.trunk.count, 0)") == 0
            assert (
                page.evaluate("shown.panels[0].solid.scene.background.getHexString()") == "102030"
            )
        browser.close()


#: Places around the eye that are in the picture but not in sight, or behind it and yet in sight;
#: bodies drawn at each level.
_SIGHT = """() => {
  const [panel] = shown.panels, { camera, parts } = panel.solid, sight = sightOf(camera, false);
  const missed = [], needless = [];
  for (let x = -30; x <= 30; x += 0.7) {
    for (let y = -30; y <= 30; y += 0.7) {
      const place = new THREE.Vector3(sight.at.x + x, 0.9, sight.at.z - y);
      const away = -place.clone().applyMatrix4(camera.matrixWorldInverse).z;
      const { x: across, y: up } = place.clone().project(camera);
      const seen = distanceSeen(sight, place.x, -place.z) < Infinity;
      if (away > 0 && Math.abs(across) < 1 && Math.abs(up) < 1 && !seen) missed.push([x, y]);
      if (away < -6 && seen) needless.push([x, y]);
    }
  }
  return { missed, needless, levels: parts.people.bodies.map(({ trunk }) => trunk.count) };
}"""


@pytest.mark.slow
@needs_browser
def test_who_is_in_sight_is_drawn_the_plainer_the_farther_away(tmp_path: Path) -> None:
    write_replay(tmp_path / "page.html", replace(passing(), solids=_SOLIDS))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=_SOFTWARE)
        with Visit(browser, tmp_path / "page.html", "#t=4") as page:
            page.evaluate("state.playing = false")
            levels = set[int]()
            eyes = (("camera", 5, 1.6), ("solid", 5, 0.0), ("solid", 14, 0.0), ("solid", 40, 0.0))
            for view, far, yaw in eyes:
                page.select_option("#view", view)
                until(page, "shown.panels[0].solid")
                frames = page.evaluate("shown.panels[0].solid.frames")
                changed = f"around.far = {far}, shown.panels[0].gaze.yaw = {yaw}"
                page.evaluate(f"shown.panels[0].{changed}, ask()")
                until(page, f"shown.panels[0].solid.frames > {frames}")
                found = page.evaluate(_SIGHT)
                assert found["missed"] == found["needless"] == []
                levels |= {k for k, count in enumerate(found["levels"]) if count}
            assert levels == {0, 1, 2}
        browser.close()
