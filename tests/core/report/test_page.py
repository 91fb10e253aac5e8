"""The page as a file: what is in it, what is not, and that hostile names stay names."""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import json
import re
import zlib
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crowdbot.core.report.cards import card, reference
from crowdbot.core.report.markdown import markdown
from crowdbot.core.report.page import render, write_report
from crowdbot.core.report.tables import csv_parts
from crowdbot.core.results.failure import Failure
from crowdbot.core.results.results import Results
from crowdbot.core.statistics.estimate_text import joined_text
from crowdbot.errors import InputError
from tests.core.report.report_cases import campaign, contents, full
from tests.core.results.made_up_record import changed

EVIL = "</script><script>alert(1)</script><!-- \"'& \u2028 |`[x](y)"
SMALL_AXES = {"density": ("d0125", "d0500"), "flow": ("in", "counter"), "range": ("r02", "r05")}
METRICS = ("relative_time_to_goal", "risk", "success", "effect_on_time", "agreement")


def small(**changes: Any) -> Results:
    return campaign(**{"axes": SMALL_AXES, "metrics": METRICS, **changes})


class Page(HTMLParser):
    """Tags, words, and scripts by id."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: dict[str | None, str] = {}
        self.style, self.words = "", ""
        self._open: tuple[str, str | None] = ("", None)
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._open = (tag, dict(attrs).get("id"))

    def handle_endtag(self, tag: str) -> None:
        del tag
        self._open = ("", None)

    def handle_data(self, data: str) -> None:
        tag, name = self._open
        if tag == "script":
            self.scripts[name] = self.scripts.get(name, "") + data
        elif tag == "style":
            self.style += data
        else:
            self.words += data

    @property
    def meta(self) -> Any:
        return json.loads(self._blob("meta"), parse_constant=lambda c: pytest.fail(c))

    def numbers(self, name: str) -> NDArray[Any]:
        planes = np.frombuffer(self._blob(name), np.uint8).reshape(4, -1)
        words = np.zeros((planes.shape[1], 8), np.uint8)
        words[:, :4] = planes.T
        return words.reshape(-1).view(">f8").astype(float)

    def codes(self) -> NDArray[Any]:
        return np.frombuffer(self._blob("codes"), "<u2")

    def _blob(self, name: str) -> bytes:
        return zlib.decompress(base64.b64decode(self.scripts[f"blob-{name}"], validate=True))


def test_every_score_is_in_the_page_to_five_digits() -> None:
    results = small()
    page = Page(render(contents(results)))
    meta = page.meta
    shape = (len(meta["series"]), meta["runs"]["count"])
    values, codes = page.numbers("values").reshape(shape), page.codes()
    upper = page.numbers("upper").reshape(shape)
    series = {(s["metric"], s["variant"]): i for i, s in enumerate(meta["series"])}
    runs = {r.run_id: i for i, r in enumerate(results.runs)}
    failed = {r.run_id for r in results.runs if r.status == "planner_failed"}
    seen = 0
    for score in results.scores:
        at = series[score.metric, score.variant], runs[score.run_id]
        state = meta["states"][codes.reshape(shape)[at]]
        if score.run_id in failed and score.status != "ok":
            assert state == ["failed", "planner_failed"]
            continue
        assert state == [score.status, score.reason]
        for blob, number in ((values, score.value), (upper, score.upper)):
            if number is None:
                assert np.isnan(blob[at])
            else:
                assert blob[at] == pytest.approx(number, rel=1e-5, abs=0)
            whole = number is not None and number == round(number)
            assert not whole or blob[at] == number
        seen += score.status == "censored"
    assert seen > 0


def test_failures_of_the_campaign_are_attempts_like_others() -> None:
    results = small(failures=3)
    made_good = results.runs[0]
    late = Failure(
        suite=made_good.suite, scenario=made_good.scenario, planner=made_good.planner,
        seed=made_good.seed, error="killed", traceback="",
    )  # fmt: skip
    deep = replace(results.failures[1], traceback="\n".join(f"line {i}" for i in range(999)))
    failures = (results.failures[0], deep, results.failures[2], late)
    report = contents(replace(results, failures=failures))
    meta = Page(render(report)).meta
    assert meta["runs"]["count"] == 3 * 8
    statuses = [meta["statuses"][s] for s in meta["runs"]["status"]]
    assert statuses.count("failed") == 3  # the fourth was made good
    assert "MemoryError" in meta["runs"]["traceback"]["21"]
    excerpt = meta["runs"]["traceback"]["22"].splitlines()
    assert (excerpt[0], excerpt[-1], len(excerpt)) == ("… 975 lines …", "line 998", 25)
    scenarios = meta["runs"]["scenario"]
    twin = scenarios.index(scenarios[21])  # another planner's run of it
    assert [axis[21] for axis in meta["runs"]["axes"]] == [
        axis[twin] for axis in meta["runs"]["axes"]
    ]


@pytest.mark.slow
def test_nothing_comes_from_outside() -> None:
    text = render(full())
    page = Page(text)
    for name, script in page.scripts.items():
        if name and name.startswith("blob-"):
            text = text.replace(script, "")  # base64 has slashes
    text = text.replace("http://www.w3.org/2000/svg", "")  # a name, not an address
    assert not re.search(r"https?:|wss?:|//\w|@import|url\(|fetch\(|XMLHttp|innerHTML|eval\(", text)
    for tag, attributes in page.tags:
        assert tag not in ("link", "img", "iframe", "object", "base", "form")
        assert not {"src", "style"} & set(attributes)
        assert (attributes.get("href") or "#").startswith("#")
        assert not any(name.startswith("on") for name in attributes)


def test_policy_allows_our_style_and_script_only() -> None:
    page = Page(render(contents(small())))
    policy = next(a["content"] for _, a in page.tags if "http-equiv" in a)

    def hashed(text: str) -> str:
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    assert policy == (
        f"default-src 'none'; script-src {hashed(page.scripts[None])}; "
        f"style-src {hashed(page.style)}; img-src blob:; base-uri 'none'; form-action 'none'"
    )


def hostile() -> Results:
    """Every text that a user or a plugin can choose is hostile."""
    found = small(planners={EVIL: 0.0, "good": -0.5})
    record = {
        "versions": {EVIL: EVIL},
        "plugins": [{"name": EVIL}],
    }
    runs = tuple(
        changed(
            r, scenario=EVIL + r.scenario, reason=EVIL, axes={EVIL: EVIL, **r.axes},
            planner={EVIL: {EVIL: EVIL}, "label": r.planner}, conditions={EVIL: EVIL}, **record,
        )
        for r in found.runs
    )  # fmt: skip
    scores = tuple(
        replace(s, category=EVIL, metric=EVIL + s.metric, symbol=EVIL, unit=EVIL,
                reason=EVIL if s.reason else "")
        for s in found.scores
    )  # fmt: skip
    failures = tuple(replace(f, error=EVIL, traceback=EVIL) for f in found.failures)
    return Results(runs=runs, scores=scores, failures=failures)


def test_hostile_text_stays_text() -> None:
    report = contents(hostile(), made=EVIL, command=EVIL, accepted=(EVIL,), warnings=(EVIL,))
    page, clean = Page(render(report)), Page(render(contents(small())))
    count = [tag for tag, _ in clean.tags].count("script")
    assert [tag for tag, _ in page.tags].count("script") == count
    assert page.words.count("alert(1)") >= 10
    assert all("alert" not in text for key, text in page.scripts.items() if key != "meta")
    rows = list(csv.reader(io.StringIO(b"".join(csv_parts(report)).decode(), newline="")))
    assert {len(row) for row in rows} == {len(rows[0])}
    lines = [line for line in markdown(report).splitlines() if line.startswith("|")]
    cells = {re.sub(r"\\.", "", line).count("|") for line in lines}
    assert cells == {7, 8}  # one number of columns for each of the three tables
    assert "[x](y)" not in markdown(report)
    assert "<script>" not in re.sub(r"\\.", "", markdown(report))


def test_differences_that_were_accepted_are_prominent() -> None:
    report = contents(small(), accepted=("rates: 16 Hz, 20 Hz",), warnings=("processor: x",))
    page = Page(render(report))
    notices = [
        a["class"] for tag, a in page.tags if tag == "p" and "notice" in (a.get("class") or "")
    ]
    assert [n for n in notices if "floors" not in str(n)][1:3] == ["notice accepted", "notice"]
    assert page.words.index("rates: 16 Hz") < page.words.index("how the runs ended")
    assert "**Accepted: rates: 16 Hz, 20 Hz**" in markdown(report)


def test_csv_has_every_score_and_every_failure(tmp_path: Path) -> None:
    results = small(failures=2)
    paths = write_report(tmp_path / "x.html", contents(results))
    with paths["csv"].open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(results.scores) + 2
    assert [r["run_status"] for r in rows[-2:]] == ["failed", "failed"]
    assert rows[-1]["axis.density"] == "d0500"
    assert "MemoryError" in rows[-1]["reason"]
    by_place = {(r.scenario, r.planner, r.seed): r.run_id for r in results.runs}
    scores = {(s.run_id, s.metric, s.variant): s.value for s in results.scores}
    for row in rows[:-2]:
        run = by_place[row["scenario"], row["planner"], int(row["seed"])]
        value = scores[run, row["metric"], row["variant"]]
        assert (float(row["value"]) if row["value"] else None) == value


@pytest.mark.slow
def test_markdown_says_what_the_page_says() -> None:
    report = full()
    text = markdown(report)
    line = next(x for x in text.splitlines() if x.startswith("| relative_time_to_goal "))
    score = next(
        s for s in report.figures.headline.scores
        if (s.metric, s.planner) == ("relative_time_to_goal", "straight_on")
    )  # fmt: skip
    assert score.mean.low is not None
    assert f"{score.mean.value:.3f} [{score.mean.low:.3f}, " in line
    assert f"{joined_text(score.mean)}; 14 censored" in line
    assert "not distinguishable" in text
    assert "a is better" in text


def test_yes_or_no_is_told_as_a_share() -> None:
    counted = ("success", "risk", "collision_count", "contacts_per_km")
    report = contents(small(metrics=counted))
    place = next(i for i, s in enumerate(report.series) if s.metric == "success")
    assert report.series[place].centre == "share"
    assert {s.centre for s in report.series if s.metric in ("risk", "collision_count")} == {"mean"}
    assert next(s for s in report.series if s.metric == "contacts_per_km").centre == "rate"
    arrived = [
        s.value for s in report.results.scores if s.metric == "success"
        and s.run_id in {r.run_id for r in report.results.runs if r.planner == "dwa"}
    ]  # fmt: skip
    dwa = report.figures.intervals[0, place, report.planners.index("dwa")]
    assert dwa[0] == pytest.approx(np.mean(np.array(arrived, dtype=float)))
    assert dwa[2] <= 1.0


def test_a_page_of_three_planners_and_162_scenarios_is_small(tmp_path: Path) -> None:
    paths = write_report(tmp_path / "report.html", full())
    assert paths["html"].stat().st_size < 1_500_000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["report.csv", "report.html", "report.md"]


def test_equal_input_gives_equal_bytes() -> None:
    assert render(contents(small())) == render(contents(small()))


def test_nothing_to_report_is_an_error() -> None:
    with pytest.raises(InputError, match="no run"):
        contents(replace(small(), runs=(), scores=()))


def test_runs_without_any_score_have_a_report() -> None:
    page = Page(render(contents(replace(small(), scores=()))))
    assert page.meta["series"] == []


def test_cards_are_read_by_their_parts() -> None:
    found = full().cards["velocity_similarity"]
    assert found["summary"].endswith(".")
    assert ["better", "reference"] in [list(row) for row in found["head"]]
    assert set(found["variants"]) == {"literal", "corrected"}
    assert reference(found) == {"value": 1.0, "meaning": "like the people"}
    assert reference(full().cards["proximity"]) is None
    assert dict(full().cards["neighbour_velocity_similarity"]["head"])["unit"] == "1"
    assert card("# x\n\nNo more than this.\n")["summary"] == "No more than this."
