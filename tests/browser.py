"""What tests of pages share: the browser, a visit that hears complaints, and axe-core."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.paths import ROOT

_NAMES = ("chromium", "google-chrome", "chromium-browser", "google-chrome-stable")
#: The browser that is installed, if any.
PROGRAM = next(filter(None, map(shutil.which, _NAMES)), None)
#: `make check-js` puts it there.
AXE = ROOT / "scripts/js/node_modules/axe-core/axe.min.js"
needs_browser = pytest.mark.skipif(PROGRAM is None, reason=f"no browser: {', '.join(_NAMES)}")
needs_axe = pytest.mark.skipif(not AXE.is_file(), reason="no axe-core: make check-js")


class Visit:
    """A page, and everything that it asked for or complained about."""

    def __init__(self, browser: Browser, path: Path, fragment: str = "", **context: Any) -> None:
        context.setdefault("viewport", {"width": 1280, "height": 900})
        self.page: Page = browser.new_page(**context)
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda m: self.complaints.append(m.text))
        self.page.on("pageerror", lambda e: self.complaints.append(str(e)))
        self.page.on("request", lambda r: self.requests.append(r.url))
        self.page.on("dialog", lambda d: self.complaints.append(d.message))
        self.page.goto(f"{path.as_uri()}{fragment}")
        self.page.wait_for_selector("html[data-ready]")

    def __enter__(self) -> Page:
        return self.page

    def __exit__(self, *error: object) -> None:
        url = self.page.url
        self.page.close()
        if error[0] is None:
            assert self.complaints == [], self.complaints
            asked = {u.partition("#")[0] for u in self.requests if not u.startswith("blob:")}
            assert asked == {url.partition("#")[0]}


def axe_findings(page: Page) -> list[str]:
    """What axe-core finds wrong with a page as it is shown now: rule, element and reason."""
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
    return [
        f"{rule['id']}: {node['html'][:120]}: {node['failureSummary']}"
        for rule in found["violations"]
        for node in rule["nodes"]
    ]
