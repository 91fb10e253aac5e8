"""A person draws a scenario in a browser."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, sync_playwright

from crowdbot.core.editor.desk import Desk
from crowdbot.core.editor.server import Server
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec
from tests.browser import PROGRAM, needs_browser

pytestmark = [pytest.mark.slow, needs_browser]

_START = """\
# A drawing with comments.
crowdbot: 1
scenario:
  id: drawn # keep this
  environment:
    kind: floor
    area: {x: [0, 20], y: [0, 10]} # and this
"""


class _Hand:
    """Clicks and drags in metres, counted as actions."""

    def __init__(self, page: Page) -> None:
        self.page, self.actions = page, 0

    def _at(self, x: float, y: float) -> Any:
        return self.page.evaluate(
            "([x, y]) => { const m = document.getElementById('plan').getScreenCTM();"
            "const p = new DOMPoint(x, -y).matrixTransform(m); return [p.x, p.y]; }",
            [x, y],
        )

    def _idle(self) -> None:
        self.page.wait_for_timeout(30)
        self.page.evaluate("() => queue")
        self.page.wait_for_timeout(30)

    def tool(self, name: str) -> None:
        self.page.click(f"#tool-{name}")
        self.actions += 1

    def click(self, x: float, y: float) -> None:
        self.page.mouse.click(*self._at(x, y))
        self.actions += 1
        self._idle()

    def drag(self, x0: float, y0: float, x1: float, y1: float) -> None:
        self.page.mouse.move(*self._at(x0, y0))
        self.page.mouse.down()
        self.page.mouse.move(*self._at(x1, y1), steps=3)
        self.page.mouse.up()
        self.actions += 1
        self._idle()

    def press(self, keys: str) -> None:
        self.page.keyboard.press(keys)
        self.actions += 1
        self._idle()

    def text(self) -> str:
        return self.page.input_value("#text")


def test_twenty_people_two_walls_and_a_robot(tmp_path: Path) -> None:
    file = tmp_path / "drawn.yaml"
    file.write_text(_START)
    server = Server(Desk(file, discover()))
    threading.Thread(target=server.run, daemon=True).start()
    complaints: list[str] = []
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=PROGRAM)
        page = browser.new_page(viewport={"width": 1400, "height": 900})
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(server.url)
        page.wait_for_selector("html[data-ready]", state="attached")
        hand = _Hand(page)
        hand.tool("wall")
        hand.drag(5, 0.5, 5, 4)
        hand.drag(5, 6, 5, 9.5)
        hand.tool("robot")
        hand.click(2, 5)
        hand.tool("person")
        for k in range(20):
            hand.click(7 + 1.2 * (k % 10), 3 if k < 10 else 7)
        drawn_ = hand.text()
        hand.press("Control+z")
        assert hand.text().count("{id: ") == drawn_.count("{id: ") - 1
        hand.press("Control+y")
        assert hand.text() == drawn_
        hand.tool("select")
        hand.drag(2, 5, 2, 6)
        hand.press("ArrowUp")
        hand.press("Control+s")
        assert page.inner_text("#status") == "saved"
        assert hand.actions < 60
        browser.close()
    server.close()
    assert complaints == []
    text = file.read_text()
    assert all(c in text for c in ("# A drawing with comments.", "# keep this", "# and this"))
    scenario = open_spec(str(file), discover()).scenarios[0]
    assert scenario.crowd is not None
    assert len(scenario.crowd.agents) == 20
    env: Any = scenario.environment
    assert [w.start for w in env.walls.values()] == [(5.0, 0.5), (5.0, 6.0)]
    assert scenario.robots["robot"].task.start == (2.0, 6.1, 0.0)
