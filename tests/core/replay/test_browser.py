"""The page in a real browser: each interaction does what it says, offline, without a finding."""

from __future__ import annotations

import base64
import io
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from crowdbot.core.replay.other_track import OtherTrack
from crowdbot.core.replay.page import write_replay
from tests.browser import PROGRAM, Visit, axe_findings, needs_axe, needs_browser
from tests.core.replay.replay_cases import ARRIVED_AT, CONTACT_AT, NEAR_AT, passing
from tests.core.replay.test_replay import EVIL

pytestmark = [pytest.mark.slow, needs_browser]
_TWO = ("dwa", "stop_and_go")


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def one(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("one") / "replay.html"
    write_replay(path, passing())
    return path


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("two") / "compare.html"
    write_replay(path, passing(_TWO[0]), passing(_TWO[1], speed=0.4, aside=0.9), title="compared")
    return path


def clock(page: Page) -> float:
    return float(page.inner_text("#clock").split(" ")[0])


def settled(page: Page) -> None:
    """Until what was asked for is drawn, and the address is written."""
    page.evaluate("new Promise((done) => setTimeout(() => requestAnimationFrame(done), 250))")


def until(page: Page, condition: str) -> None:
    """Until an expression holds; the policy of the page forbids `Page.wait_for_function`."""
    for _ in range(1000):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(20)
    pytest.fail(f"never true: {condition}")


def at(page: Page, x: float, y: float, panel: int = 0) -> tuple[float, float]:
    """Where a point of the world is in the window."""
    canvas = page.query_selector_all(".closeup canvas")[panel].bounding_box()
    view = page.evaluate(f"(({{x, y, scale}}) => [x, y, scale])(shown.panels[{panel}].view)")
    assert canvas is not None
    return (
        canvas["x"] + canvas["width"] / 2 + (x - view[0]) * view[2],
        canvas["y"] + canvas["height"] / 2 - (y - view[1]) * view[2],
    )


def readout(page: Page, panel: int = 0) -> dict[str, str]:
    """Names and values beside a view."""
    lists = page.query_selector_all(".readout")
    rows = lists[panel].query_selector_all("div")
    return {
        row.query_selector("dt").inner_text(): row.query_selector("dd").inner_text()  # type: ignore[union-attr]
        for row in rows
    }


def pixels(page: Page, selector: str) -> Any:
    """What a canvas shows: (height, width, 4), 0 to 255."""
    text = page.eval_on_selector(selector, "(canvas) => canvas.toDataURL()")
    picture = imread(io.BytesIO(base64.b64decode(text.partition(",")[2])))
    return (picture * 255).round().astype(int)


def commonest(picture: Any) -> list[int]:
    """The colour of most pixels, red, green and blue, 0 to 255: the floor."""
    colours = picture[..., :3].round().astype(int).reshape(-1, 3)
    found, counts = np.unique(colours, axis=0, return_counts=True)
    return [int(part) for part in found[counts.argmax()]]


def test_it_opens_offline_and_lists_what_happened(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused", offline=True) as page:
        events = [e.inner_text() for e in page.query_selector_all("#event-list button")]
        assert [re.sub(r"\s+", " ", e) for e in events] == [
            f"{NEAR_AT} s 0.05 m from person 7",
            f"{CONTACT_AT} s contact with person 9, front, 2.5 N s",
            f"{ARRIVED_AT} s robot arrives",
        ]
        page.click("#event-list button >> nth=0")
        settled(page)
        assert clock(page) == NEAR_AT
        assert f"t={NEAR_AT:.2f}" in page.url
        page.click("#event-list button >> nth=1")
        settled(page)
        assert clock(page) == CONTACT_AT - 0.5
        page.uncheck('#event-kinds [value="near miss"]')
        assert not page.is_visible("#event-list button >> nth=0")
        for key, time in (("c", CONTACT_AT - 0.5), ("e", ARRIVED_AT), ("e", NEAR_AT)):
            page.keyboard.press("Home" if key == "c" else "Shift")
            page.keyboard.press(key)
            settled(page)
            assert clock(page) == time


def test_robots_of_a_fleet_are_chosen_by_their_names(browser: Browser, tmp_path: Path) -> None:
    shown = passing()
    other = OtherTrack(
        name="qolo", run=replace(shown.run, agents=None, trips=None), look=(), leaves=False
    )
    write_replay(tmp_path / "fleet.html", replace(shown, robot="pepper", others=[other]))
    with Visit(browser, tmp_path / "fleet.html", "#paused&t=4") as page:
        texts = page.eval_on_selector_all("#whom option", "all => all.map((o) => o.textContent)")
        assert texts[:4] == ["no one", "robot: pepper", "robot 2: qolo", "person 7"]
        page.select_option("#whom", label="robot 2: qolo")
        settled(page)
        assert "follow=robot+2" in page.url


def test_somebody_is_followed(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused&t=4") as page:
        assert readout(page)["speed"] == "0.50\u00a0m/s"
        page.mouse.click(*at(page, 2.0, 0.55))
        settled(page)
        assert page.input_value("#whom") == "person 7"
        assert "follow=person+7" in page.url
        found = readout(page)
        assert found["person"] == "7"
        assert found["x, y"] == "2.00, 0.55\u00a0m"
        assert found["from robot"] == "0.05\u00a0m"
        assert page.evaluate("shown.panels[0].view.x") == pytest.approx(2.0)
        assert "followed" in page.inner_text("#legend")

        page.mouse.click(*at(page, 2.0, 0.0))
        settled(page)
        assert page.input_value("#whom") == "robot"
        assert readout(page)["heading"] == "0\u00a0°"
        page.select_option("#whom", "person 9")
        settled(page)
        assert page.evaluate("shown.panels[0].view.y") == pytest.approx(-0.45)

        x, y = at(page, 3.0, 1.0)
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 80, y, steps=4)
        page.mouse.up()
        settled(page)
        assert page.input_value("#whom") == ""
        assert page.evaluate("shown.panels[0].view.x") < 3.4


def test_the_address_keeps_the_view(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused") as page:
        page.evaluate("byId('scrub').value = 3.25; byId('scrub').oninput({target: byId('scrub')})")
        page.click("#trails")
        page.click("#lidar")
        page.click("#in")
        page.click("#plots summary")
        page.check('#plot-choice input[value="speed"]')
        page.check('#plot-choice input[value="signal/my/signal"]')
        page.click("#theme")
        settled(page)
        fragment = "#" + page.url.partition("#")[2]
        assert "t=3.25" in fragment
        assert "lidar" not in page.inner_text("#legend")
        assert "where people were" in page.inner_text("#legend")
        span = page.evaluate("state.span")
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        page.click("#link")
        until(page, "byId('said').textContent !== ''")
        assert page.evaluate("navigator.clipboard.readText()").endswith(fragment)
    with Visit(browser, one, fragment) as page:
        assert clock(page) == 3.25
        assert page.get_attribute("#lidar", "aria-pressed") == "false"
        assert page.get_attribute("#trails", "aria-pressed") == "true"
        assert page.evaluate("state.span") == pytest.approx(span, abs=0.01)
        assert page.get_attribute("html", "data-theme") == "dark"
        assert len(page.query_selector_all(".plot")) == 2
        page.evaluate("location.hash = '#t=7'")
        settled(page)
        assert clock(page) == 7.0


def test_plots_show_any_signal(browser: Browser, one: Path) -> None:
    fragment = "#paused&t=5&plot=clearance,signal%2Fmy%2Fsignal,signal%2Fplanner%20step%20time"
    with Visit(browser, one, fragment) as page:
        entries = [e.inner_text() for e in page.query_selector_all(".plot figcaption")]
        assert [re.sub(r"\s+", " ", text).strip() for text in entries] == [
            "distance to the nearest person, m 0.2433 m",
            f"my/signal {np.sin(5.0):.4g}".replace("-", "−"),
            "planner step time 0.001",
        ]
        canvas = page.query_selector(".plot canvas")
        assert canvas is not None
        box = canvas.bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + 46 + 0.2 * (box["width"] - 46), box["y"] + 20)
        settled(page)
        assert clock(page) == pytest.approx(2.0, abs=0.05)
        assert len(np.unique(pixels(page, ".plot canvas").reshape(-1, 4), axis=0)) > 3


@pytest.mark.parametrize(
    ("values", "low", "high", "ticks"),
    [
        ([-1.17, 0.86], -1.5, 1.0, [-1.0, 0.0, 1.0]),
        ([0.0, 0.65], 0.0, 0.7, [0.0, 0.5]),
        ([0.28, 2.8], 0.0, 3.0, [0.0, 1.0, 2.0, 3.0]),
        ([7.0, 7.0], 7.0, 8.0, [7.0, 7.5, 8.0]),
        ([], 0.0, 1.0, [0.0, 1.0]),
    ],
)
def test_axes_of_plots_have_round_numbers(
    values: list[float], low: float, high: float, ticks: list[float], browser: Browser, one: Path
) -> None:
    with Visit(browser, one, "#paused") as page:
        axis = page.evaluate("(values) => axisOf([{ values }])", values)
    assert [axis["low"], axis["high"]] == pytest.approx([low, high])
    assert axis["ticks"] == pytest.approx(ticks)


def test_cameras_show_the_latest_image(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused&t=1") as page:
        assert (pixels(page, ".camera canvas") == [204, 0, 0, 255]).all()
        depth = pixels(page, ".camera:nth-child(2) canvas")
        assert depth[0, 0].tolist() == [70, 40, 90, 255]
        assert len(np.unique(depth.reshape(-1, 4), axis=0)) == 2
        page.keyboard.press("End")
        settled(page)
        assert (pixels(page, ".camera canvas") == [0, 204, 0, 255]).all()
        page.keyboard.press("Home")
        settled(page)
        assert "nothing yet" in page.inner_text("#camera-figures")


def test_pictures_and_clips_are_saved(browser: Browser, two: Path) -> None:
    with Visit(browser, two, "#paused&t=4", accept_downloads=True) as page:
        page.click("#save summary")
        with page.expect_download() as download:
            page.click("#png")
        assert download.value.suggested_filename == "compared-4.00s.png"
        picture = imread(io.BytesIO(download.value.path().read_bytes()))
        assert picture.shape[1] == 2400
        assert len(np.unique((picture[::7, ::7, :3] * 255).astype(int).reshape(-1, 3), axis=0)) > 20

        page.fill("#clip-from", "3")
        page.fill("#clip-to", "2")
        page.click("#clip")
        assert "ends after it begins" in page.inner_text("#said")
        page.fill("#clip-to", "3.4")
        for kind in ("gif", "webm"):
            page.select_option("#clip-format", kind)
            with page.expect_download() as download:
                page.click("#clip")
            data = download.value.path().read_bytes()
            assert download.value.suggested_filename == f"compared-3.00-3.40s.{kind}"
            if kind == "webm":
                assert data[:4] == b"\x1a\x45\xdf\xa3"
                assert len(data) > 5000
                continue
            clip = Image.open(io.BytesIO(data))
            assert (clip.n_frames, clip.size[0], clip.info["duration"]) == (5, 800, 80)  # type: ignore[attr-defined]
            frames = []
            for k in (0, 4):
                clip.seek(k)
                frames.append(np.array(clip.convert("RGB")))
            assert commonest(frames[0]) == pytest.approx(commonest(picture * 255), abs=2)
            shown = (frames[0] != frames[1]).any(axis=2).mean()
            assert 0.0005 < shown < 0.5
        until(page, "byId('said').textContent.startsWith('The clip is saved')")
        assert clock(page) == 4.0


def test_runs_are_compared(browser: Browser, two: Path) -> None:
    with Visit(browser, two, "#paused&t=5") as page:
        assert [e.inner_text() for e in page.query_selector_all(".caption .name")] == list(_TWO)
        assert [readout(page, i)["speed"] for i in (0, 1)] == ["0.50\u00a0m/s", "0.40\u00a0m/s"]
        heads = [e.inner_text() for e in page.query_selector_all("aside thead th")]
        assert heads == ["Metric", *_TWO]
        cells = page.query_selector_all("aside tbody tr:nth-child(2) .value")
        assert [e.inner_text() for e in cells] == ["2", "1.6"]
        assert page.evaluate("shown.panels.map(({view}) => view.x)") == [2.5, 2.0]

        seen = pixels(page, ".closeup canvas")
        assert "other run" in page.inner_text("#legend")
        page.keyboard.press("g")
        settled(page)
        assert "other run" not in page.inner_text("#legend")
        assert (pixels(page, ".closeup canvas") != seen).any()
        page.mouse.click(*at(page, 3.45, -0.45, panel=1))
        settled(page)
        assert [readout(page, i)["person"] for i in (0, 1)] == ["9", "9"]


def test_another_run_is_added(browser: Browser, one: Path, tmp_path: Path) -> None:
    for name, run in (("a.html", passing("dwa")), ("b.html", passing("other", speed=0.3))):
        write_replay(tmp_path / name, run)
    (tmp_path / "c.html").write_text("<p>nothing")
    visit = Visit(browser, tmp_path / "a.html", "#paused&t=2&with=b.html")
    with visit as page:
        visit.requests = [u for u in visit.requests if "b.html" not in u]
        assert page.evaluate("shown.runs.map((run) => run.label)") == ["dwa", "other"]
        assert "with=b.html" in page.url
        page.click("#save summary")
        page.set_input_files("#other", str(one))
        until(page, "shown.runs.length === 3")
        assert page.evaluate("shown.runs.map((run) => run.label)")[2] == "dwa (2)"
        page.set_input_files("#other", str(tmp_path / "c.html"))
        until(page, "byId('said').textContent.includes('is not a replay page')")
        assert len(page.query_selector_all(".closeup")) == 3
    with Visit(browser, one, "#paused&with=https://example.org/x.html") as page:
        assert "is not beside this page" in page.inner_text("#said")
        assert page.evaluate("shown.runs.length") == 1


@pytest.mark.parametrize(
    ("address", "shown"),
    [("../report.html", True), ("javascript:alert(1)", False), ("https://example.org/", False)],
)
def test_the_way_back_to_the_report(address: str, shown: bool, browser: Browser, one: Path) -> None:
    with Visit(browser, one, f"#paused&report={address}") as page:
        assert page.is_visible("#report") == shown
        if shown:
            href = page.evaluate("byId('report').href")
            assert href == (one.parent.parent / "report.html").as_uri()
            page.keyboard.press("End")
            settled(page)
            assert "report=" in page.url


def test_paper_keeps_circles(browser: Browser, two: Path) -> None:
    with Visit(browser, two, "#paused&t=4&theme=dark") as page:
        page.emulate_media(media="print")
        page.set_viewport_size({"width": 700, "height": 1000})  # A4 within its margins
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        assert page.evaluate("colours.floor") == "#fffefb"
        for canvas in page.query_selector_all("#overview, .closeup canvas"):
            stretch = canvas.evaluate(
                "(c) => { const b = c.getBoundingClientRect();"
                " return (b.width / c.width) / (b.height / c.height); }"
            )
            assert stretch == pytest.approx(1.0, abs=0.02)
        assert not page.is_visible("#play")
        assert not page.is_visible("#plots")
        assert not page.is_visible("#variants")
        assert page.is_visible("#legend")
        assert page.evaluate("document.documentElement.scrollWidth") <= 700
        page.evaluate("dispatchEvent(new Event('afterprint'))")
        assert page.get_attribute("html", "data-theme") == "dark"
        assert len(page.pdf(format="A4")) > 30_000


def test_plots_that_are_open_are_printed(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused&t=4&plot=speed") as page:
        page.emulate_media(media="print")
        assert page.is_visible(".plot canvas")
        assert not page.is_visible("#plot-choice")


@needs_axe
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(scheme: str, browser: Browser, one: Path, two: Path) -> None:
    for path in (one, two):
        with Visit(browser, path, "#paused&t=6.6&plot=speed", color_scheme=scheme) as page:
            page.click("#save summary")
            assert axe_findings(page) == []
            for width in (360, 768, 1920):
                page.set_viewport_size({"width": width, "height": 900})
                assert page.evaluate("document.documentElement.scrollWidth") <= width
            page.set_viewport_size({"width": 360, "height": 740})
            assert axe_findings(page) == []
            page.click("#theme")
            assert (page.get_attribute("html", "data-theme") == "dark") == (scheme == "light")
            assert axe_findings(page) == []


def test_keys_and_playing(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused&t=4") as page:
        page.keyboard.press("ArrowRight")
        settled(page)
        assert clock(page) == pytest.approx(4.0625, abs=0.006)
        page.keyboard.press("Shift+ArrowLeft")
        settled(page)
        assert clock(page) == pytest.approx(3.0625, abs=0.006)
        page.select_option("#speed", "1")  # the end, where it stops by itself, is seconds away
        page.evaluate("document.activeElement.blur()")
        page.keyboard.press(" ")
        until(page, "parseFloat(byId('clock').textContent) > 3.3")
        assert page.get_attribute("#play", "aria-label") == "Pause"
        page.keyboard.press("-")
        page.keyboard.press(" ")
        assert page.get_attribute("#play", "aria-label") == "Play"
        assert page.input_value("#speed") == "0.5"
        for key, name in (("l", "lidar"), ("s", "sonar"), ("t", "trails")):
            was = page.get_attribute(f"#{name}", "aria-pressed")
            page.keyboard.press(key)
            assert page.get_attribute(f"#{name}", "aria-pressed") != was
        page.keyboard.press("f")
        assert page.input_value("#whom") == ""


def test_legend_names_what_stands_there(browser: Browser, one: Path) -> None:
    with Visit(browser, one, "#paused") as page:
        legend = page.inner_text("#legend")
        stands = ("wall for robots only", "block", "block that people step over", "pillar", "goal")
        for words in ("robot", "its path", "contact", *stands):
            assert words in legend
        assert "wall for people only" not in legend
        assert "other run" not in legend


def test_hostile_names_and_odd_runs(browser: Browser, tmp_path: Path) -> None:
    evil = replace(passing(EVIL), title=EVIL)
    bare = replace(passing(), run=replace(evil.run, robot=None, contacts=None), scans=())
    alone = replace(passing(), run=replace(evil.run, agents=None, contacts=None), scenery=None)
    for i, run in enumerate((evil, bare, alone)):
        path = tmp_path / f"{i}.html"
        write_replay(path, run)
        with Visit(browser, path, "#paused&t=nonsense&plot=x,y&follow=person 99") as page:
            assert not page.is_visible("#failure")
            page.keyboard.press("e")
            page.keyboard.press("End")
            if run is evil:
                assert "<script>alert(1)" in page.inner_text("h1")
