"""Every kind of page that a command writes: axe-core finds nothing, phone or wide, light or dark.

Replays and reports are tried with menus open, and at more widths, by the tests of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from playwright.sync_api import Browser, sync_playwright

from crowdbot import cli
from crowdbot.core.campaign.sweep.page import render as render_sweep
from crowdbot.core.campaign.sweep.search import Sweep
from crowdbot.core.editor.page import page as editor_page
from crowdbot.core.live.person.page import render_person_page
from crowdbot.core.realism.measure import measure_tracks
from crowdbot.core.realism.near_robots import page as near_robots_page
from crowdbot.core.realism.near_robots.encounters import encounters_of
from crowdbot.core.realism.near_robots.measure import measure_encounters
from crowdbot.core.realism.near_robots.reference import reference_of
from crowdbot.core.realism.page import render
from crowdbot.core.realism.reference import shipped
from crowdbot.core.registry.registry import discover
from crowdbot.core.replay.page import write_replay
from crowdbot.core.report.page import write_report
from crowdbot.core.site.write import INDEX
from crowdbot.core.studies.findings import compare
from crowdbot.core.studies.report.report import write_study_report
from tests.browser import PROGRAM, axe_findings, needs_axe, needs_browser
from tests.cli.test_why import SCENARIO
from tests.core.bundle.made_up_runs import make_bundle, write_suite
from tests.core.campaign.test_sweep import request, tried
from tests.core.realism.near_robots.walks import various
from tests.core.realism.test_compare import people
from tests.core.replay.replay_cases import passing
from tests.core.report.report_cases import contents
from tests.core.statistics.test_floors import results
from tests.core.studies.study_cases import study_of
from tests.core.studies.test_findings import VALUES, rows
from tests.paths import ROOT


def replay(path: Path) -> None:
    write_replay(path, passing())


def comparison(path: Path) -> None:
    write_replay(path, passing("dwa"), passing("stop_and_go", speed=0.4), title="compared")


def report(path: Path) -> None:
    write_report(path, contents(results({"mine": [1, 1, 0, 1], "blind": [0, 0, 1, 0]})))


def leaderboard(path: Path) -> None:
    for i, planner in enumerate(("dwa", "goal_seek")):
        name = f"{planner}.cbz"
        make_bundle(path.parent, planner, name, team=planner, value=lambda k, i=i: k + i)
    assert cli.main(["leaderboard", str(path.parent), "--out", str(path)]) == 0


def realism(path: Path) -> None:
    places = np.array([[-4.0, 0.0], [4.0, 0.6], [-4.0, 0.6]])
    tracks = people(np.array([[1.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]), places, 34)
    path.write_text(render("people", [measure_tracks("people", [[tracks]], shipped())]))


def scenario(path: Path) -> None:
    words = ["view", "social-guidelines", "crossing_left", "--out", str(path)]
    assert cli.main(words) == 0


def near_robots(path: Path) -> None:
    met = encounters_of(various(12))
    found = measure_encounters("people", met, reference_of(met, ["made up"]))
    path.write_text(near_robots_page.render("near robots", [found]))


def why(path: Path) -> None:
    (path.parent / "crossing.yaml").write_text(SCENARIO)
    words = ["simulate", str(path.parent / "crossing.yaml"), "--planner", "goal_seek", "--quiet"]
    runs = path.parent / "runs"
    assert cli.main([*words, "--no-references", "--out", str(runs)]) == 0
    assert cli.main(["why", str(runs), "--out", str(path)]) == 0


def drive(path: Path) -> None:
    path.write_text(render_person_page("drive", "crossing"))


def walk(path: Path) -> None:
    path.write_text(render_person_page("walk", "crossing"))


def editor(path: Path) -> None:
    path.write_text(editor_page("crossing.yaml", "token"))


def site(path: Path) -> None:
    suite = write_suite(path.parent)
    for planner in ("dwa", "goal_seek"):
        make_bundle(path.parent, planner, f"{planner}.cbz", team=planner)
    folder = str(path.parent)
    assert cli.main(["challenge-page", str(suite), folder, "--out", folder]) == 0
    (path.parent / INDEX).rename(path)


def sweep(path: Path) -> None:
    best, usual = tried("1", 0.6, 0.55), tried("", 0.5, 0.5)
    found = Sweep(request=request(path.parent), tried=(best, tried("0.5", 0.4)), usual=usual)
    path.write_text(render_sweep(found))


def study_report(path: Path) -> None:
    name = "safe_efficiency.corrected"
    people = {"p1": "p01", "p2": "p02", "p3": "p03", "p4": "p04"}
    drives = [
        {"participant": people[row["participant"]], "condition": row["condition"],
         "driver": "teleop", name: row["x.y"]}
        for row in rows(VALUES)
    ]  # fmt: skip
    found = {name: compare(drives, ["alone", "helped"], name)}
    write_study_report(path, study_of(path.parent), drives, found, discover(allow=()))


#: Pages that only a server makes; ``tests/cli/test_study_page.py`` walks through them.
ELSEWHERE = {"core/studies/runner"}
#: All other kinds of pages: the package that holds the parts -> who makes one.
PAGES: dict[str, tuple[Callable[[Path], None], ...]] = {
    "core/bundle": (leaderboard,),
    "core/campaign/sweep": (sweep,),
    "core/editor": (editor,),
    "core/live/person": (drive, walk),
    "core/realism": (realism,),
    "core/realism/near_robots": (near_robots,),
    "core/replay": (replay, comparison),
    "core/report": (report,),
    "core/site": (site,),
    "core/studies/report": (study_report,),
    "core/view": (scenario,),
    "core/why": (why,),
}
#: Pages whose scripts unpack their data before they draw.
UNPACKED = (report, replay, comparison)
MAKERS = [maker for makers in PAGES.values() for maker in makers]


def test_every_kind_of_page_is_listed() -> None:
    product = ROOT / "crowdbot"
    parts = {p.parent.relative_to(product).as_posix() for p in product.rglob("*.html.j2")}
    assert parts == set(PAGES) | ELSEWHERE
    # Nobody writes a page in another way.
    of_their_own = [p for p in product.rglob("*.py") if "<!doctype html" in p.read_text().lower()]
    assert of_their_own == []


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.mark.slow
@needs_browser
@needs_axe
@pytest.mark.parametrize("make", MAKERS, ids=lambda make: make.__name__)
def test_axe_finds_nothing(make: Callable[[Path], None], browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    make(path)
    schemes: tuple[Literal["light", "dark"], ...] = ("light", "dark")
    for scheme in schemes:
        page = browser.new_page(color_scheme=scheme, offline=True)
        page.goto(path.as_uri())
        if make in UNPACKED:
            page.wait_for_selector("html[data-ready]")
        for width in (360, 1280):
            page.set_viewport_size({"width": width, "height": 900})
            assert axe_findings(page) == [], (scheme, width)
            assert page.evaluate("document.documentElement.scrollWidth") <= width
        page.close()
