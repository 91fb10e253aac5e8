"""The page of a scenario in a browser: axe-core finds nothing, phone or wide, light or dark."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

from crowdbot.cli import main
from tests.browser import PROGRAM, axe_findings, needs_axe, needs_browser

pytestmark = [pytest.mark.slow, needs_browser, needs_axe]


def test_axe_finds_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "view.html"
    words = ["view", "social-guidelines", "crossing_left", "--out", str(out)]
    monkeypatch.setattr("sys.argv", ["crowdbot", *words])
    main()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=["--no-sandbox"])
        for width, scheme in ((360, "light"), (1920, "dark")):
            page = browser.new_page(
                viewport={"width": width, "height": 900},
                color_scheme="dark" if scheme == "dark" else "light",
                offline=True,
            )
            page.goto(out.as_uri())
            assert axe_findings(page) == []
            assert page.evaluate("document.documentElement.scrollWidth") <= width
        browser.close()
