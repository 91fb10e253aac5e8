"""The site of a challenge: pages, pictures, and entries that the round does not rank."""

from __future__ import annotations

import json
import os
import re
from datetime import UTC, datetime
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.core.bundle.check_edition import late
from crowdbot.core.bundle.judge_log import LOG, RECEIVED, LogLine, append
from crowdbot.core.bundle.verification import content_hash, save_verification
from tests.core.bundle.made_up_runs import make_bundle, write_suite
from tests.paths import ROOT

TEMPLATE = ROOT / "crowdbot" / "templates" / "planner" / "package"
ROUND = (
    "round: {closes: 2027-03-31, planners: sealed, contact: us@example.org, prize: A <b>cup</b>,\n"
    '  organisers: Lab A and Lab B, venue: Hall W, about: "First.\\n\\nSecond."}\n'
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    suite = write_suite(folder)
    suite.write_text(suite.read_text() + ROUND)
    for planner in ("dwa", "goal_seek"):
        make_bundle(folder, planner, f"{planner}.cbz", team="A <b>team</b>")
    return folder


def test_without_bundles(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "new" / "site"
    assert cli.main(["challenge-page", str(folder / "tiny.yaml"), "--out", str(out)]) == 0
    page = (out / "index.html").read_text()
    assert "Nothing was handed in yet" in page
    assert '<a href="mailto:us@example.org">' in page
    assert "31 March 2027, in UTC at the end of the day" in page
    for expected in ("Lab A and Lab B", "Hall W", "A &lt;b&gt;cup&lt;/b&gt;", "<p>Second.</p>"):
        assert expected in page
    assert "crowdbot seal mine.py:Mine" in page
    pictures = re.findall(r'<img src="([^"]+)"', page)
    assert pictures
    assert all((out / name).read_text().startswith("<?xml") for name in pictures)
    assert all(name.endswith("-small.svg") for name in pictures)  # without a legend
    assert all((out / name.replace("-small", "")).is_file() for name in pictures)
    assert "http" not in re.sub(r"<[^>]*Security-Policy[^>]*>", "", page)


def test_with_bundles(folder: Path, tmp_path: Path) -> None:
    arguments = ["challenge-page", str(folder / "tiny.yaml"), str(folder)]
    assert cli.main([*arguments, "--out", str(tmp_path)]) == 0
    board = (tmp_path / "leaderboard.html").read_text()
    links = re.findall(r'href="([^"#]+)"', board + (tmp_path / "index.html").read_text())
    assert {"./bundles/dwa.cbz", "suite/tiny.yaml", "suite/tiny.lock.json"} <= set(links)
    assert all((tmp_path / link).is_file() for link in links if ":" not in link)
    assert (tmp_path / "bundles/dwa.cbz").read_bytes() == (folder / "dwa.cbz").read_bytes()
    assert "A &lt;b&gt;team&lt;/b&gt;" in board
    assert board.count("not ranked: this round ranks sealed planners only") == 2
    page = (tmp_path / "index.html").read_text()
    assert "<li value" not in page
    assert "· dwa is not ranked: this round ranks sealed planners only</p>" in page


def test_a_copy_of_the_suite_with_other_rules_decides_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    suite = write_suite(tmp_path)
    own = suite.read_text()
    suite.write_text(own + "round: {closes: 2099-01-01}\n")  # the forger's copy
    make_bundle(tmp_path, "dwa", "dwa.cbz", team="Sly")
    for rule, expected in (
        ("closes: 2020-01-01", "late: the round closed on 2020-01-01"),
        ("planners: sealed", "not ranked: this round ranks sealed planners only"),
    ):
        suite.write_text(f"{own}round: {{{rule}}}\n")
        for command in (
            ["challenge-page", str(suite), str(tmp_path), "--out", str(tmp_path / "site")],
            ["leaderboard", str(tmp_path), "--suite", str(suite), "--out",
             str(tmp_path / "site" / "leaderboard.html")],
        ):  # fmt: skip
            assert cli.main(command) == 0
            assert expected in (tmp_path / "site" / "leaderboard.html").read_text()
    arguments = ["verify", str(tmp_path / "dwa.cbz"), "--suite", str(suite), "--sample", "0"]
    suite.write_text(f"{own}round: {{closes: 2020-01-01}}\n")
    capsys.readouterr()
    assert cli.main([*arguments, "--json"]) == 0
    assert "closed on 2020-01-01" in json.loads(capsys.readouterr().out)["late"]


@pytest.mark.parametrize("outcome", ["suspicious", "invalid", "nondeterministic"])
def test_what_the_organisers_refused_has_no_rank(tmp_path: Path, outcome: str) -> None:
    suite = write_suite(tmp_path)
    for planner in ("dwa", "goal_seek"):
        bundle = make_bundle(tmp_path, planner, f"{planner}.cbz", team=planner.title())
    record = {"sha256": content_hash(bundle), "outcome": outcome, "ok": False, "runs": {}}
    save_verification(bundle, record)
    out = tmp_path / "site"
    assert cli.main(["challenge-page", str(suite), str(tmp_path), "--out", str(out)]) == 0
    page = (out / "index.html").read_text()
    listed = page.partition('id="board"')[2].partition("</section>")[0]
    assert re.findall(r"<li[^>]*>([^<]+)", listed) == ["Dwa · dwa"]
    assert f"is not ranked: the organisers found it {outcome}</p>" in page
    board = (out / "leaderboard.html").read_text()
    assert f'class="{outcome}"' in board
    assert f"not ranked: the organisers found it {outcome}" in board


def test_bundles_are_ranked_where_a_round_takes_them(tmp_path: Path) -> None:
    suite = write_suite(tmp_path)
    for planner in ("dwa", "goal_seek"):
        make_bundle(tmp_path, planner, f"{planner}.cbz", team="A <b>team</b>")
    out = tmp_path / "site"
    assert cli.main(["challenge-page", str(suite), str(tmp_path), "--out", str(out)]) == 0
    page = (out / "index.html").read_text()
    assert "A &lt;b&gt;team&lt;/b&gt; · dwa" in page
    assert "crowdbot plugins new mine --planner" in page
    assert (TEMPLATE / "give_way.py.tmpl").is_file()
    assert "tiny.yaml --planner mine.give_way</pre>" in page
    assert "tiny.yaml --planner mine.give_way --team" in page


def test_bundles_of_another_suite_are_no_site(folder: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.yaml"
    other.write_text((folder / "tiny.yaml").read_text().replace("id: tiny", "id: other"))
    arguments = ["challenge-page", str(other), str(folder), "--out", str(tmp_path)]
    assert cli.main(arguments) == 1
    assert not (tmp_path / "index.html").exists()


def test_a_bundle_after_the_round_is_told(tmp_path: Path) -> None:
    bundle = tmp_path / "a.cbz"
    bundle.touch()
    for moment, note in (
        (datetime(2027, 3, 31, 20, tzinfo=UTC), ""),
        (datetime(2027, 4, 1, 8, 30, tzinfo=UTC), "the file is of 2027-04-01 08:30 UTC"),
    ):
        os.utime(bundle, (moment.timestamp(), moment.timestamp()))
        assert late(bundle, "2027-03-31").endswith(note)
        assert bool(late(bundle, "2027-03-31")) is bool(note)


def test_the_page_of_hidden_draws_asks_for_sealed_planners(tmp_path: Path) -> None:
    suite = write_suite(tmp_path)
    suite.write_text(suite.read_text() + "round: {contact: us@example.org}\n")
    assert cli.main(["draws", "commit", str(suite)]) == 0
    out = tmp_path / "site"
    assert cli.main(["challenge-page", str(suite), "--out", str(out)]) == 0
    page = (out / "index.html").read_text()
    assert str(tmp_path) not in page
    assert "campaign tiny.yaml --planner mine.py:Mine --set crowd.seed.root=1</pre>" in page
    assert "send the file to us@example.org" in page
    assert "crowdbot bundle" not in page
    assert re.search(r"<dt>commitment</dt><dd><code>[^<]+</code>", page)
    drawing = (out / re.findall(r'<img src="([^"]+)"', page)[0]).read_text()
    assert "<path" in drawing
    assert '<circle class="person' not in drawing

    judged = tmp_path / "judged"
    judged.mkdir()
    arguments = ["challenge-page", str(suite), str(judged), "--out", str(out)]
    assert cli.main(arguments) == 1  # neither bundles nor a log
    lines = list[LogLine]()
    for number in range(2):
        append(judged / LOG, lines, RECEIVED, submission=str(number))
    assert cli.main(arguments) == 0
    page = (out / "index.html").read_text()
    assert "2 sealed planners received" in page
    assert f"<code>{lines[-1].sha256}</code>" in page
    assert "Nothing was run yet" in page


def test_too_few_crowds_are_told_before_the_round(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    suite = write_suite(tmp_path)
    suite.with_suffix(".lock.json").unlink()
    before, out = suite.read_text(), tmp_path / "site"
    for draws, warned in ((1, True), (3, False)):
        suite.write_text(f"{before}draws: {draws}\n")
        capsys.readouterr()
        assert cli.main(["challenge-page", str(suite), "--out", str(out)]) == 0
        warning = "all planners will share one rank: "
        assert (warning in capsys.readouterr().err) is warned
        assert (warning[1:] in (out / "index.html").read_text()) is warned
