"""The replay page in three dimensions: each view is drawn, with what sensors and planner know."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import sync_playwright

from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.replay import write_replay
from tests.browser import PROGRAM, Visit, needs_browser
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
_LINES = "shown.panels[0].solid.parts.{}.geometry.drawRange.count"


@pytest.mark.slow
@needs_browser
def test_each_view_shows_people_robot_sensors_and_tracks(tmp_path: Path) -> None:
    track = np.array([[3.0, 1.0, 0.5, 0.1, 0.0]])
    drawn = {"tracks": [PlannerDrawing(t=t / 4, rows=track) for t in range(40)]}
    write_replay(tmp_path / "page.html", replace(passing(), solids=_SOLIDS, drawings=drawn))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=_SOFTWARE)
        with Visit(browser, tmp_path / "page.html", "#t=4") as page:
            page.evaluate("state.playing = false")
            for view in ("solid", "person", "camera"):
                before = page.evaluate("shown.panels[0].solid?.frames ?? 0")
                page.select_option("#view", view)
                until(page, f"(shown.panels[0].solid?.frames ?? 0) > {before}")
                assert page.evaluate(_LINES.format("thoughts")) == 8  # a cross, a pole, its way
                assert page.evaluate(_LINES.format("points")) == 90
                assert page.evaluate(_LINES.format("cones")) == 2 * 8
                assert page.evaluate(f"{_INFO}.triangles") > 200
            assert page.evaluate(f"{_INFO}.calls") < 20
            page.click("#lidar")
            until(page, _LINES.format("points") + " === 0")
            page.select_option("#view", "plan")
            assert page.is_visible(".closeup canvas")
        browser.close()
