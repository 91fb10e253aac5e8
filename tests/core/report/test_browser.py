"""The page in a real browser: it opens offline, its filters tell the truth, keys are enough."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urljoin

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser, Page, sync_playwright

from crowdbot.core.report.contents import Contents
from crowdbot.core.report.page import write_report
from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.record_parts import MomentPart
from crowdbot.core.statistics.estimate import Estimate
from crowdbot.core.statistics.estimate_text import estimate_text
from tests.browser import PROGRAM, Visit, axe_findings, needs_axe, needs_browser
from tests.core.report.report_cases import AXES, campaign, contents, full
from tests.core.report.test_page import EVIL, hostile, small

pytestmark = [pytest.mark.slow, needs_browser]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report")
    return write_report(folder / "report.html", full())["html"]


def _moment(run: RunRow) -> MomentPart:
    assert run.record.worst_moment is not None
    return run.record.worst_moment


def values(report: Contents, metric: str, variant: str, planner: str, **axes: str) -> NDArray[Any]:
    """What a planner scored in the runs with these labels, from the results alone."""
    runs = {
        r.run_id
        for r in report.results.runs
        if r.planner == planner and all(r.axes[name] == label for name, label in axes.items())
    }
    found = [
        s.value
        for s in report.results.scores
        if (s.metric, s.variant) == (metric, variant) and s.run_id in runs and s.value is not None
    ]
    return np.sort(np.array(found))


def shown(page: Page, score: str) -> list[tuple[float, str]]:
    """Number and brackets in the cells of a row of the table of scores."""
    cells = page.query_selector_all(f'tr[data-score="{score}"] td.number')
    return [
        (
            number(c.query_selector("b")),
            "".join(e.inner_text() for e in c.query_selector_all("small")),
        )
        for c in cells
    ]


def texts(value: float, low: float, high: float) -> tuple[float, str]:
    """What `shown` finds of an estimate."""
    value_text, ends = estimate_text(Estimate(value=value, low=low, high=high))
    return float(value_text), ends


def number(element: Any) -> float:
    return float(element.inner_text().replace("−", "-"))


def test_it_opens_offline(browser: Browser, path: Path) -> None:
    with Visit(browser, path, offline=True) as page:
        assert page.get_attribute("html", "data-ready")
        assert page.inner_text("#shown") == "486 of 486 runs"
        assert len(page.query_selector_all("#distribution circle")) > 450
        assert len(page.query_selector_all("#panels figure")) == len(AXES)


def test_a_filter_changes_the_numbers_to_those_of_its_runs(
    browser: Browser, path: Path, tmp_path: Path
) -> None:
    report = full()
    with Visit(browser, path) as page:
        everything = shown(page, "risk.rate")
        expected = [values(report, "risk", "rate", p).mean() for p in report.planners]
        assert [v for v, _ in everything] == pytest.approx(expected, abs=0.005)

        page.select_option("#axis-density", "d0500")
        one = shown(page, "risk.rate")
        for p, planner in enumerate(report.planners):
            chosen = values(report, "risk", "rate", planner, density="d0500")
            place = report.figures.selections.index("density=d0500")
            series = next(i for i, s in enumerate(report.series) if s.name == ("risk", "rate"))
            value, low, high = report.figures.intervals[place, series, p]
            assert chosen.mean() == pytest.approx(value)
            assert one[p] == texts(value, low, high)
        assert one != everything
        assert page.inner_text("#shown") == "162 of 486 runs"

        page.select_option("#axis-flow", "counter")
        two = shown(page, "risk.rate")
        chosen = values(report, "risk", "rate", "dwa", density="d0500", flow="counter")
        q1, q3 = np.quantile(chosen, [0.25, 0.75])
        assert two[0] == texts(chosen.mean(), q1, q3)
        assert page.query_selector('tr[data-score="risk.rate"] .quartile')
        assert page.inner_text("#filter-text") == "Only flow = counter; density = d0500."
        assert not page.is_visible("#pairs-table")  # nobody has worked that out

        page.screenshot(path=tmp_path / "filtered.png")
        assert (tmp_path / "filtered.png").stat().st_size > 20_000
        page.click("#clear")
        assert shown(page, "risk.rate") == everything


def test_planners_categories_and_variants_can_be_chosen(browser: Browser, path: Path) -> None:
    with Visit(browser, path) as page:
        page.click("#planner-0")
        assert page.get_attribute("#planner-0", "aria-pressed") == "false"
        assert len(shown(page, "risk.rate")) == 2
        page.select_option("#category", "collision")
        rows = page.query_selector_all("#scores-table tr[data-score]")
        assert {"risk.rate", "collision_count.corrected"} <= {
            r.get_attribute("data-score") for r in rows
        }
        assert not page.query_selector('tr[data-score="spl.corrected"]')
        page.select_option("#variant", "literal")
        assert page.query_selector('tr[data-score="risk.literal"]')
        assert not page.query_selector('tr[data-score="risk.rate"]')
        assert "without a value" not in page.inner_text("#scores-silent")


def test_the_address_keeps_the_view(browser: Browser, path: Path) -> None:
    with Visit(browser, path) as page:
        page.select_option("#axis-speed", "fast")
        page.click('tr[data-score="proximity.corrected"] .metric')
        page.click("#chart-ecdf")
        page.click("#planner-2")
        fragment = "#" + page.url.partition("#")[2]
        seen = page.inner_text("#scores-table")
    with Visit(browser, path, fragment) as page:
        assert page.inner_text("#scores-table") == seen
        assert page.input_value("#axis-speed") == "fast"
        assert page.inner_text("#chosen").startswith("proximity")
        assert page.query_selector("#distribution .curve")
    with Visit(browser, path, "#axis.speed=nobody&score=x.y&planners=9&pair=77") as page:
        assert page.inner_text("#filter-text").startswith("Only planners")
        page.click("#clear")
        assert page.inner_text("#shown") == "486 of 486 runs"


def test_verdicts_are_those_of_the_statistics(browser: Browser, path: Path) -> None:
    report = full()
    found = {(c.a, c.b): c for c in report.figures.headline.comparisons if c.metric == "proximity"}
    with Visit(browser, path, "#score=proximity.corrected") as page:
        rows = page.query_selector_all("#pairs-table tbody tr")
        for row, ((a, b), comparison) in zip(rows, found.items(), strict=True):
            words = row.inner_text()
            assert a in words
            assert b in words
            expected = {"better": f"{a} is better", "worse": f"{b} is better"}
            assert expected.get(comparison.verdict, comparison.verdict) in words
            assert comparison.difference.value is not None
            assert f"{comparison.difference.value:.2f}".replace("-", "−") in words
        verdicts = {c.verdict for c in found.values()}
        assert verdicts == {"better", "not distinguishable"}
        marks = page.query_selector_all('tr[data-score="proximity.corrected"] .decided')
        assert [m.get_attribute("aria-label") for m in marks] == [
            "dwa better than straight_on", "orca_lookahead better than straight_on",
        ]  # fmt: skip


def test_what_has_no_value_is_counted_and_drawn(browser: Browser, path: Path) -> None:
    report = full()
    censored = [
        s for s in report.results.scores
        if (s.metric, s.variant) == ("relative_time_to_goal", "corrected") and s.status != "ok"
    ]  # fmt: skip
    with Visit(browser, path, "#score=relative_time_to_goal.corrected") as page:
        text = page.inner_text('tr[data-score="relative_time_to_goal.corrected"]')
        censored_count = sum(int(n) for n in re.findall(r"(\d+) censored", text))
        assert (
            censored_count == len(page.query_selector_all("#distribution .bound")) <= len(censored)
        )
        assert censored_count == len(censored) - sum(
            r.status == "planner_failed" and any(s.run_id == r.run_id for s in censored)
            for r in report.results.runs
        )
        assert "no command" in page.inner_text("#scores-silent")


def test_failures_are_found_with_their_replays(browser: Browser, path: Path) -> None:
    report = full()
    with Visit(browser, path, "#score=risk.corrected") as page:
        counts = report.counts()
        rows = page.query_selector_all("#failed-table tbody tr")
        assert len(rows) == sum(counts.values()) - counts["arrived"]
        page.click("#failed-table summary >> nth=0")
        assert "Traceback" in page.inner_text("#failed-table pre >> nth=0")
        worst = page.query_selector("#worst-table tbody tr")
        assert worst is not None
        scores = [
            s for s in report.results.scores if (s.metric, s.variant) == ("risk", "corrected")
        ]
        top = max(scores, key=lambda s: s.value or 0.0)
        run = next(r for r in report.results.runs if r.run_id == top.run_id)
        assert run.scenario in worst.inner_text()
        link = worst.query_selector("a")
        assert link is not None
        moment = _moment(run).t
        up = "../" * (1 + len(Path(run.directory).parts))
        assert link.get_attribute("href") == (
            f"runs/{run.directory}/replay.html#t={round(moment, 2):g}&report={up}{path.name}"
        )


def test_keys_are_enough(browser: Browser, path: Path) -> None:
    with Visit(browser, path) as page:
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.className") == "skip"
        assert page.evaluate("document.activeElement.getBoundingClientRect().left") >= 0
        page.keyboard.press("Enter")
        assert page.evaluate("document.activeElement.id") == "main"

        name = 'tr[data-score="relative_jerk.corrected"] .metric'
        page.focus(name)
        assert (
            page.evaluate(f"getComputedStyle(document.querySelector('{name}')).outlineStyle")
            == "solid"
        )
        card = page.inner_text("#card")
        assert "J_rp" in card
        assert "higher" in card
        assert page.get_attribute(name, "aria-describedby") == "card"
        page.keyboard.press("Escape")
        assert not page.is_visible("#card")
        page.hover('tr[data-score="risk.rate"] .metric')
        page.wait_for_selector("#card:visible")
        assert "R" in page.inner_text("#card")
        page.keyboard.press("Escape")

        head = "#worst-table th:nth-child(2)"
        page.focus(f"{head} button")
        page.keyboard.press("Enter")
        assert page.get_attribute(head, "aria-sort") == "ascending"
        page.keyboard.press("Enter")
        assert page.get_attribute(head, "aria-sort") == "descending"
        ids = [e.inner_text() for e in page.query_selector_all("#worst-table .id")]
        assert ids == sorted(ids, reverse=True)
        page.focus("#axis-density")
        page.keyboard.press("ArrowDown")
        assert page.inner_text("#filter-text") == "Only density = d0125."
        nameless = page.evaluate(
            "[...document.querySelectorAll('select, button, input')].filter((e) =>"
            " !e.textContent.trim() && !e.labels?.length && !e.ariaLabel).length"
        )
        assert nameless == 0
        unlabelled = page.evaluate(
            "[...document.querySelectorAll('select')].filter((e) => !e.labels.length).length"
        )
        assert unlabelled == 0


def contrast(page: Page, selector: str) -> float:
    """Contrast of an element's text with the panel behind it (WCAG 2.2, 1.4.3)."""
    script = """(selector) => {
      const parse = (text) => text.match(/[\\d.]+/g).slice(0, 3).map(Number);
      const light = ([r, g, b]) => [r, g, b].map((c) => c / 255)
        .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
        .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
      const style = (what) => getComputedStyle(document.querySelector(what));
      const ink = light(parse(style(selector).color));
      const paper = light(parse(style("section").backgroundColor));
      return (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    }"""
    return float(page.evaluate(script, selector))


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_and_dark(scheme: str, browser: Browser, path: Path, tmp_path: Path) -> None:
    background = "getComputedStyle(document.body).backgroundColor"
    with Visit(browser, path, color_scheme=scheme) as page:
        first = page.evaluate(background)
        assert (sum(map(int, re.findall(r"\d+", first))) < 200) == (scheme == "dark")
        for selector in ("td b", "td small", ".note", ".about", ".made", "nav a"):
            assert contrast(page, selector) >= 4.5, selector
        page.screenshot(path=tmp_path / f"{scheme}.png")
        page.click("#theme")
        assert page.evaluate(background) != first
        assert f"theme={'light' if scheme == 'dark' else 'dark'}" in page.url


@pytest.mark.parametrize("width", [1280, 800])
def test_nothing_sticks_out(width: int, browser: Browser, path: Path) -> None:
    with Visit(browser, path, viewport={"width": width, "height": 900}) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        cut = page.evaluate(
            "[...document.querySelectorAll('.wide')].filter((e) =>"
            " e.scrollWidth > e.clientWidth + 1).map((e) => e.firstElementChild.id)"
        )
        assert cut == []


def test_print_has_the_filters_and_whole_tables(browser: Browser, path: Path) -> None:
    with Visit(browser, path, "#axis.range=r05") as page:
        page.emulate_media(media="print")
        page.set_viewport_size({"width": 700, "height": 1000})  # A4 within its margins
        page.evaluate("dispatchEvent(new Event('beforeprint'))")
        assert not page.is_visible("#filters")
        assert page.inner_text("#filter-text") == "Only range = r05."
        assert page.is_visible(".glossary")
        wide = page.evaluate(
            "[...document.querySelectorAll('table')].filter((e) => e.offsetWidth &&"
            " e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.id)"
        )
        assert wide == []
        page.evaluate("dispatchEvent(new Event('afterprint'))")
        assert not page.is_visible(".glossary")
        assert len(page.pdf(format="A4")) > 50_000


def test_hostile_names_are_shown_as_they_are(browser: Browser, tmp_path: Path) -> None:
    report = contents(hostile(), accepted=(EVIL,))
    with Visit(browser, write_report(tmp_path / "x.html", report)["html"]) as page:
        assert "<script>alert(1)</script>" in page.inner_text(".lead")
        assert "<script>alert(1)</script>" in page.inner_text("#scores-table thead")
        page.select_option(f"[id='axis-{re.sub('[^a-z]', '', 'density')}']", "d0500")
        page.focus("#scores-table .metric >> nth=0")
        assert "not installed" in page.inner_text("#card")


@pytest.mark.parametrize("planners", [1, 7])
def test_one_planner_or_many_and_seeds(planners: int, browser: Browser, tmp_path: Path) -> None:
    names = {f"planner_{i}_with_a_long_name": -0.1 * i for i in range(planners)}
    report = contents(small(planners=names, seeds=2, failures=0))
    path = write_report(tmp_path / "x.html", report)["html"]
    with Visit(browser, path) as page:
        assert page.evaluate("document.documentElement.scrollWidth") <= 1280
        page.select_option("#seed", "1")
        assert page.inner_text("#shown") == f"{planners * 8} of {planners * 16} runs"
        assert page.is_visible("#pairs-note")


def test_a_campaign_without_scores_or_axes_can_be_looked_at(
    browser: Browser, tmp_path: Path
) -> None:
    results = campaign(axes={"only": ("x",)}, metrics=[], failures=0)
    bare = contents(results)
    with Visit(browser, write_report(tmp_path / "x.html", bare)["html"]) as page:
        assert page.is_visible("#failures")
        assert not page.is_visible("#one-score")


@pytest.mark.parametrize("size", [0.0, 1.0, -1e-12, 1e9, 1e100])
def test_numbers_that_differ_by_rounding_alone_are_drawn(
    size: float, browser: Browser, tmp_path: Path
) -> None:
    found = small(planners={"a": 0.0, "b": 0.0}, failures=0)
    scores = tuple(
        s if s.value is None else replace(s, value=size * (1 + 2e-16 * (i % 3)))
        for i, s in enumerate(found.scores)
    )
    path = write_report(tmp_path / "x.html", contents(replace(found, scores=scores)))["html"]
    with Visit(browser, path, "#score=risk.corrected") as page:
        assert page.query_selector("#distribution circle")
        assert len(page.query_selector_all("#distribution .tick")) < 40


def test_a_dot_says_which_run_it_is_and_opens_it_at_its_worst_moment(
    browser: Browser, path: Path
) -> None:
    runs = {r.directory: r for r in full().results.runs}
    with Visit(browser, path, "#score=risk.corrected") as page:
        links = page.query_selector_all("#distribution a")
        assert len(links) == len(runs)
        found = re.fullmatch(
            r"runs/(.*)/replay.html#t=([\d.]+)&report=\S+", links[0].get_attribute("href") or ""
        )
        assert found is not None
        run = runs[found[1]]
        assert float(found[2]) == pytest.approx(_moment(run).t, abs=0.006)
        page.hover("#distribution a >> nth=0 >> circle", force=True)
        tip = page.inner_text("#tip")
        assert run.scenario in tip
        assert _moment(run).what in tip


def test_pictures_are_saved_as_svg_png_and_csv(browser: Browser, path: Path) -> None:
    score = "#score=risk.corrected"
    with Visit(browser, path, score) as page:
        saved = {}
        for box in ("#distribution-save", "#forest-save", "#panels figure:nth-child(4) .saves"):
            for kind in ("SVG", "PNG", "CSV"):
                with page.expect_download() as download:
                    page.click(f"{box} button:text-is('{kind}')")
                saved[box, kind] = download.value.path().read_bytes()
        for (_, kind), data in saved.items():
            assert data.startswith({"SVG": b"<svg", "PNG": b"\x89PNG", "CSV": b""}[kind])
        rows = list(csv.DictReader(io.StringIO(saved["#distribution-save", "CSV"].decode())))
        value = {
            (r.scenario, r.planner): s.value
            for s in full().results.scores if (s.metric, s.variant) == ("risk", "corrected")
            for r in full().results.runs if r.run_id == s.run_id
        }  # fmt: skip
        entries = [r for r in rows if r["value"]]
        assert len(entries) > 450
        for row in entries:
            seen = value[row["scenario"], row["planner"]]
            assert float(row["value"]) == pytest.approx(seen, rel=1e-4)
        picture = saved["#distribution-save", "SVG"].decode()
        assert "risk" in picture  # the title of the axis
        assert "var(" not in picture
        words = saved["#panels figure:nth-child(4) .saves", "CSV"].decode()
        assert "ttca_dca weight,c20,20,dwa," in words


def test_axes_are_told_in_words_and_planners_sorted_by_value(browser: Browser, path: Path) -> None:
    with Visit(browser, path, "#score=safe_efficiency.corrected") as page:
        assert "20 (c20)" in page.inner_text("#axis-coeff")
        page.select_option("#axis-coeff", "c20")
        assert page.inner_text("#filter-text") == "Only ttca_dca weight = 20."
        page.click("#clear")
        before = page.inner_text("#scores-table thead").split()
        page.select_option("#planner-order", "value")
        after = page.inner_text("#scores-table thead").split()
        assert [w for w in after if w in full().planners][-1] == "straight_on"
        assert sorted(before) == sorted(after)
        assert "sort=value" in page.url


def test_where_planners_differ_most_says_how_to_see_both(browser: Browser, path: Path) -> None:
    with Visit(browser, path, "#score=risk.corrected") as page:
        button = page.query_selector("#differences-table tbody button")
        assert button is not None
        command = button.get_attribute("title") or ""
        assert re.fullmatch(
            r"crowdbot view runs/\S+/dwa/seed-0 runs/\S+/orca_lookahead/seed-0 --out compare.html",
            command,
        )
        href = page.eval_on_selector("#differences-table tbody .pair a", "a => a.href")
        first, _, query = href.partition("#")
        beside = parse_qs(query)["with"][0]
        assert urljoin(first, beside) == first.replace("/dwa/", "/orca_lookahead/")
        assert urljoin(first, parse_qs(query)["report"][0]) == path.as_uri()
        numbers = page.eval_on_selector_all(
            "#differences-table tbody tr", "rows => rows.map(r => r.cells[4].innerText)"
        )
        sizes = [abs(float(n.replace("\u2212", "-"))) for n in numbers]
        assert sizes == sorted(sizes, reverse=True)


@pytest.mark.parametrize(
    ("page_of_run", "address", "seen"),
    [
        ("runs/a/replay.html", "report.html", "../../report.html"),
        ("runs/a/replay.html", "runs/b/replay.html", "../b/replay.html"),
        ("replay.html", "report.html", "report.html"),
        ("../b/c/replay.html", "../b/d/replay.html", "../d/replay.html"),
    ],
)
def test_addresses_are_seen_from_a_run(
    page_of_run: str, address: str, seen: str, browser: Browser, path: Path
) -> None:
    with Visit(browser, path) as page:
        assert page.evaluate(f"seenFrom({page_of_run!r}, {address!r})") == seen
        back = page.evaluate("seenFrom('../x/replay.html', 'report.html')")
        assert back == f"../{path.parent.name}/{path.name}"


def test_small_numbers_are_not_shown_as_zero(browser: Browser, path: Path) -> None:
    with Visit(browser, path) as page:
        shown_as = page.evaluate(
            "[[0, 3], [2.5e-7, 2], [-4e-12, 9], [1e-3, 3]].map(([x, d]) => format(x, d))"
        )
        assert shown_as == ["0.000", "2.50e\u22127", "\u22124.00e\u221212", "0.001"]


@needs_axe
@pytest.mark.parametrize(("width", "scheme"), [(360, "dark"), (1920, "light")])
def test_axe_finds_nothing(width: int, scheme: str, browser: Browser, tmp_path: Path) -> None:
    report = contents(small(), accepted=("rates: 16 Hz, 20 Hz",), warnings=("processor: x",))
    path = write_report(tmp_path / "x.html", report)["html"]
    with Visit(
        browser, path, viewport={"width": width, "height": 900}, color_scheme=scheme
    ) as page:
        page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
        assert axe_findings(page) == []
        page.click("#chart-ecdf")
        assert axe_findings(page) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
