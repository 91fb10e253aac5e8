"""A participant in a browser: keyboard, forms, reload, a killed runner that goes on."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from playwright.sync_api import Page, sync_playwright

from crowdbot.core.studies.forms import TLX_MARKS
from crowdbot.core.trajectories.questionnaires import TLX_SCALES
from tests.browser import PROGRAM, axe_findings, needs_axe, needs_browser
from tests.core.studies.study_cases import STUDY, written

WIDTHS = (360, 1920)


class Runner:
    """``crowdbot study run`` of a participant, in a process of its own."""

    def __init__(self, folder: Path) -> None:
        words = ["study", "run", "study.yaml", "--participant", "p01", "--synthetic", "--page"]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "crowdbot", *words],
            cwd=folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True,
            start_new_session=True,
        )  # fmt: skip
        assert self.process.stderr is not None
        found = re.search(r"http://\S+", self.process.stderr.readline())
        assert found is not None
        self.url = found.group()

    def kill(self) -> None:
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        assert self.process.stderr is not None
        self.process.stderr.close()


def shown(page: Page, heading: str) -> None:
    """Wait for a step, which has to be readable at each width and free of findings."""
    page.wait_for_selector(f"h1:has-text('{heading}')", timeout=120_000)
    page.wait_for_selector("html[data-ready]")
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 800})
        wide = "document.documentElement.scrollWidth > document.documentElement.clientWidth"
        assert not page.evaluate(wide), heading
        assert axe_findings(page) == [], heading


@pytest.mark.slow
@needs_browser
@needs_axe
def test_a_participant_answers_is_interrupted_and_goes_on(tmp_path: Path) -> None:
    text = STUDY.replace("participants: 4", "participants: 1")
    written(tmp_path, text)
    steps = tmp_path / "study-data" / "p01" / "steps"
    runner = Runner(tmp_path)
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=PROGRAM)
            page = browser.new_page()
            complaints: list[str] = []
            page.on("console", lambda message: complaints.append(message.text))
            page.goto(runner.url)
            shown(page, "Consent")
            page.keyboard.press("Tab")
            page.keyboard.press("Space")  # agree
            page.keyboard.press("Enter")
            shown(page, "Drive 1, mode A")
            page.click("button")
            shown(page, "Workload, mode A")  # by itself, when the drive is over
            page.click("button")
            shown(page, "Workload")
            assert "6 questions are still open" in page.inner_text("[role=alert]")
            for k, scale in enumerate(TLX_SCALES):
                page.check(f"input[name={scale}][value='{TLX_MARKS[k]}']")
            page.click("button")
            shown(page, "What counted")
            runner.kill()
            assert complaints == []

            runner = Runner(tmp_path)
            page.goto(runner.url)
            shown(page, "What counted")
            for box in page.query_selector_all("fieldset"):
                box.query_selector_all("input")[0].check()
            page.click("button")
            shown(page, "Usability, mode A")
            page.reload()
            for box in page.query_selector_all("fieldset"):
                box.query_selector_all("input")[3].check()
            page.click("button")
            shown(page, "Drive 1, mode B")
            browser.close()
    finally:
        runner.kill()
    kept = json.loads((steps / "003-nasa_tlx-alone.json").read_text())["answers"]
    assert kept == {scale: str(TLX_MARKS[k]) for k, scale in enumerate(TLX_SCALES)}
    use = json.loads((steps / "005-use-alone.json").read_text())["answers"]
    assert set(use.values()) == {"3"}
    assert len(use) == 30
    weights = json.loads((steps / "004-weights-alone.json").read_text())["answers"]
    assert sum(weights.values()) == 15.0
