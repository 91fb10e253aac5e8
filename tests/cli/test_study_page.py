"""A participant in a browser: keyboard, forms, reload, a killed runner that goes on."""

from __future__ import annotations

import json
import math
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from crowdbot.core.recording.recording import Recording
from crowdbot.core.studies.forms import TLX_MARKS
from crowdbot.core.trajectories.questionnaires import TLX_SCALES
from tests.browser import PROGRAM, axe_findings, needs_axe, needs_browser
from tests.core.studies.study_cases import SCENARIO, STUDY, written

WIDTHS = (360, 1920)
SYNTHETIC = ("--synthetic", "--page")


class Runner:
    """``crowdbot study run`` of a participant, in a process of its own."""

    def __init__(self, folder: Path, *more: str) -> None:
        words = ["study", "run", "study.yaml", "--participant", "p01", *more]
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
    runner = Runner(tmp_path, *SYNTHETIC)
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

            runner = Runner(tmp_path, *SYNTHETIC)
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


def driving(page: Page) -> Page:
    """The page of a drive that waits for its start, opened by its link."""
    page.wait_for_selector("a.button", timeout=120_000)
    drive = page.context.new_page()
    drive.goto(str(page.get_attribute("a.button", "href")) + "#view=plan")
    drive.wait_for_selector("html[data-ready]")
    drive.wait_for_selector("#begin", timeout=120_000)
    drive.keyboard.down("ArrowUp")
    drive.click("#begin")
    return drive


def told(page: Page, t: float) -> None:
    """Until the run is as far as that; the policy of the page forbids `Page.wait_for_function`."""
    for _ in range(3000):
        if page.evaluate(f"shown.told && shown.told.t >= {t}"):
            return
        page.wait_for_timeout(20)
    pytest.fail(f"never at {t} s")


@pytest.mark.slow
@needs_browser
def test_a_drive_by_keyboard_that_is_killed_begins_again(tmp_path: Path) -> None:
    written(tmp_path, STUDY.replace("participants: 4", "participants: 1"))
    (tmp_path / "tiny.yaml").write_text(SCENARIO.replace("limit: 1 s", "limit: 3 s"))
    steps = tmp_path / "study-data" / "p01" / "steps"
    runner = Runner(tmp_path)
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=PROGRAM)
            page = agreed(browser, runner)
            drive = driving(page)
            told(drive, 0.3)
            runner.kill()
            assert len(list(steps.iterdir())) == 1  # the consent

            runner = Runner(tmp_path)
            page.goto(runner.url)
            page.click("button")
            drive = driving(page)
            page.wait_for_selector("h1:has-text('Workload, mode A')", timeout=120_000)
            browser.close()
    finally:
        runner.kill()
    (kept,) = (json.loads(p.read_text()) for p in sorted(steps.glob("*-trial-*.json")))
    assert kept["driver"] == "person"
    (record,) = (tmp_path / "study-data" / "runs").glob("**/run.json")
    run = json.loads(record.read_text())
    # All steps are there: of 3 s, or until it arrived, which depends on when the key was pressed.
    assert run["live"]["steps"] == math.ceil(run["sim_time"] * 16.0) > 16
    with Recording(record.parent / "run.mcap") as recording:
        robot = recording.robot(None).run.robot
    assert robot is not None
    assert robot.v.max() > 0.2  # it went ahead


def agreed(browser: Browser, runner: Runner) -> Page:
    """The page of a participant who agreed and asked for the first drive."""
    page = browser.new_context().new_page()
    page.goto(runner.url)
    page.wait_for_selector("html[data-ready]")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    page.keyboard.press("Enter")
    page.wait_for_selector("h1:has-text('Drive 1, mode A')")
    page.click("button")
    return page
