"""The leaderboard: classes, ties, states of verification, metrics of older versions."""

from __future__ import annotations

import json
import os
import re
import zipfile
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.core.bundle.entries import load_entries, old_metrics
from crowdbot.core.bundle.signature import own_public_key
from crowdbot.core.bundle.standings import set_apart, standings
from crowdbot.core.bundle.verification import content_hash, record_path, save_verification
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.core.statistics.audit import Audit, audit, write_audit
from crowdbot.errors import InputError
from tests.core.bundle.made_up_runs import make_bundle, registry, rewrite
from tests.core.results.made_up_record import changed
from tests.core.statistics.test_floors import results


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("board")
    make_bundle(folder, "dwa", "one.cbz", team="One <b>team</b>", value=lambda i: i + 0.5)
    make_bundle(folder, "goal_seek", "two.cbz", team="Two", value=lambda i: i + 0.6)
    make_bundle(folder, "stop_and_go", "three.cbz", team="Three", privileged=True)
    return folder


class Page(HTMLParser):
    """Everything that a page could ask the network for, and its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.addresses: list[str] = []
        self.tags: list[str] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [v or "" for k, v in attrs if k in ("src", "href", "action", "style")]

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def board(folder: Path, out: Path, *more: str) -> tuple[int, Page]:
    code = cli.main(["leaderboard", str(folder), "--out", str(out), "--by", "spl", *more])
    return code, Page(out.read_text(encoding="utf-8") if out.exists() else "")


@pytest.mark.slow
def test_one_offline_page(folder: Path, tmp_path: Path) -> None:
    code, page = board(folder, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert code == 0
    bundles = {Path(os.path.relpath(folder / n, tmp_path)).as_posix() for n in
               ("one.cbz", "two.cbz", "three.cbz")}  # fmt: skip
    assert set(page.addresses) == bundles
    assert not {"link", "img", "b"} & set(page.tags)
    assert page.tags.count("script") == 1
    assert re.search(
        r"default-src 'none'; script-src 'sha256-[^']+'; style-src 'sha256-[^']+'; base-uri",
        unescape(text),
    )
    assert "One <b>team</b>" in "".join(page.words)
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text
    assert text.count('tabindex="0"') == text.count('role="region"') == 4


def test_runs_of_unpacked_bundles_are_linked(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own"
    own.mkdir()
    (own / "one.cbz").write_bytes((folder / "one.cbz").read_bytes())
    with zipfile.ZipFile(own / "one.cbz") as archive:
        archive.extractall(own / "one")
        names = [n for n in archive.namelist() if n.endswith("scores.csv")]
    _, page = board(own, own / "page.html")
    assert sorted(page.addresses) == sorted(["./one.cbz", *(f"./one/{n}" for n in names)])
    assert sum(": arrived after 0.5 s" in w for w in page.words) == 6


def test_every_cell_can_be_sorted_by_and_has_a_label(folder: Path, tmp_path: Path) -> None:
    board(folder, tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    for table in re.findall(r'<table class="sortable">.*?</table>', text, re.DOTALL):
        heads = len(re.findall("<button", table))
        rows = table.split("<tr>")[2:]
        assert heads >= 7
        for row in rows:
            assert row.count("data-label=") == row.count("data-value=") == heads
    assert "@media (max-width: 640px)" in text


def test_the_same_bundles_give_the_same_page(folder: Path, tmp_path: Path) -> None:
    for name in ("a.html", "b.html"):
        board(folder, tmp_path / name)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_classes_stand_apart_and_noise_is_not_ranked(folder: Path) -> None:
    entries, left_out = load_entries(folder, registry())
    assert left_out == {}
    tables = standings(entries, "spl", ())
    assert [t.classed for t in tables] == ["sensors only", "privileged"]
    first = tables[0]
    assert [e.manifest.team for e in first.entries] == ["Two", "One <b>team</b>"]
    assert [first.rank("spl", e) for e in first.entries] == [1, 1]  # three draws prove nothing
    assert first.shares_rank("spl", first.entries[0])


def audited(suite: str, blind: float) -> Audit:
    """An audit of some suite whose floor and baseline have these values."""
    found = results({"known": [1.0] * 8, "blind": [blind] * 8})
    return audit(replace(found, runs=tuple(changed(r, suite=suite) for r in found.runs)))


def test_nobody_has_audited_it(folder: Path, tmp_path: Path) -> None:
    _, page = board(folder, tmp_path / "page.html")
    assert "no audit tells if this suite separates" in "".join(page.words)
    assert "Ranks may mean nothing." not in page.words


def test_a_suite_that_cannot_tell_is_labelled(folder: Path, tmp_path: Path) -> None:
    entries, _ = load_entries(folder, registry())
    scenarios = {run.entry.scenario: "" for e in entries for run in e.runs}
    for run in (run for e in entries for run in e.runs):
        scenarios[run.entry.scenario] = run.record.hashes.spec
    for blind, labelled in ((1.0, True), (0.0, False)):
        found = audited("tiny", blind).model_copy(update={"scenarios": scenarios})
        write_audit(tmp_path / "audit.json", found)
        _, page = board(folder, tmp_path / "a.html", "--audit", str(tmp_path / "audit.json"))
        assert ("Ranks may mean nothing." in page.words) == labelled
        assert found.text in "".join(page.words)


def test_audits_in_the_folder_are_found_and_those_of_others_left_alone(folder: Path) -> None:
    entries, _ = load_entries(folder, registry())
    tables = standings(entries, "spl", (), [audited("another", 1.0)])
    assert {t.suspicion for t in tables} == {""}
    old = standings(entries, "spl", (), [audited("tiny", 0.0)])
    assert all("audit it again" in t.suspicion for t in old)
    with pytest.raises(InputError, match="two audits of tiny"):
        standings(entries, "spl", (), [audited("tiny", 0.0)] * 2)


def test_verification_is_shown_for_the_very_bundle(folder: Path, tmp_path: Path) -> None:
    path = folder / "one.cbz"
    record = {"outcome": "verified", "sha256": content_hash(path), "runs": {"a": "identical"}}
    save_verification(path, record)
    try:
        _, page = board(folder, tmp_path / "page.html")
        assert "computed by the team; verified, 1 of 6 runs made again" in page.words
        save_verification(path, {**record, "sha256": "another one"})
        _, page = board(folder, tmp_path / "page.html")
        assert page.words.count("computed by the team, not verified") == 3
    finally:
        record_path(path).unlink()


def test_broken_bundles_are_left_out_and_told(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = tmp_path / "own"
    own.mkdir()
    (own / "good.cbz").write_bytes((folder / "one.cbz").read_bytes())
    (own / "bad.cbz").write_bytes(b"no zip")
    code, page = board(own, tmp_path / "page.html", "--json")
    captured = capsys.readouterr()
    assert code == 0
    assert "bad.cbz is left out" in captured.err
    assert list(json.loads(captured.out)["left_out"]) == ["bad.cbz"]
    assert "bad.cbz" in page.words


def test_partial_bundles_are_shown_but_not_ranked(folder: Path) -> None:
    entries, _ = load_entries(folder, registry())
    partial = [
        replace(e, manifest=e.manifest.model_copy(update={"missing": ["x seed-0"]}))
        if e.manifest.team == "Two" else e
        for e in entries
    ]  # fmt: skip
    first = standings(partial, "spl", ())[0]
    assert [e.manifest.team for e in first.entries] == ["One <b>team</b>", "Two"]
    assert [first.rank("spl", e) for e in first.entries] == [None, None]


def changed_records(bundle: Path, **changes: Any) -> bytes:
    import zipfile

    names = [n for n in zipfile.ZipFile(bundle).namelist() if n.endswith("run.json")]
    change = {n: lambda c: json.dumps(json.loads(c) | changes).encode() for n in names}
    return rewrite(bundle, change, honest=True).read_bytes()


def test_confounds_are_left_out_unless_they_are_accepted(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own"
    own.mkdir()
    (own / "one.cbz").write_bytes((folder / "one.cbz").read_bytes())
    content = changed_records(folder / "two.cbz", conditions={"perceived_radius": "1 m"})
    (own / "two.cbz").write_bytes(content)
    code, page = board(own, tmp_path / "page.html")
    assert code == 0
    assert any("cannot be compared with one.cbz: perceived_radius" in w for w in page.words)
    entries, _ = load_entries(own, registry())
    assert [e.path.name for e in set_apart(entries, ())[0]] == ["one.cbz"]
    assert len(set_apart(entries, ["perceived_radius"])[0]) == 2
    code, page = board(own, tmp_path / "page.html", "--accept", "perceived_radius")
    assert code == 0
    assert any("perceived_radius" in w and "accepted" in w for w in page.words)


def test_verified_entries_stay_before_many_others(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own"
    own.mkdir()
    other = changed_records(folder / "two.cbz", conditions={"perceived_radius": "1 m"})
    for name in ("a", "b", "c"):
        (own / f"{name}.cbz").write_bytes(other)
    honest = own / "honest.cbz"
    honest.write_bytes((folder / "one.cbz").read_bytes())
    entries, _ = load_entries(own, registry())
    assert [e.path.stem for e in set_apart(entries, ())[0]] == ["a", "b", "c"]
    record = {"outcome": "verified", "ok": True, "sha256": content_hash(honest), "runs": {"a": ""}}
    save_verification(honest, record)
    entries, _ = load_entries(own, registry(), {own_public_key()})
    assert [e.path.stem for e in set_apart(entries, ())[0]] == ["honest"]


def test_metrics_of_older_versions_are_left_out_without_recordings(
    folder: Path, tmp_path: Path
) -> None:
    own = tmp_path / "own"
    own.mkdir()
    (own / "one.cbz").write_bytes((folder / "one.cbz").read_bytes())
    older = {"risk": {"spec_version": 0}, "spl": {"spec_version": 1}}
    (own / "two.cbz").write_bytes(changed_records(folder / "two.cbz", metrics=older))
    entries, _ = load_entries(own, registry())
    assert old_metrics(entries[0].runs[0], registry()) == set()
    assert (entries[1].outdated, entries[1].rescored) == (("risk",), ())
    (table,) = standings(entries, "spl", ())
    assert table.rank("risk", entries[1]) is None
    assert table.rank("spl", entries[1]) == 1


def test_a_folder_without_bundles(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match="no bundles"):
        load_entries(tmp_path, registry())
    assert cli.main(["leaderboard", str(tmp_path)]) == 1
    assert cli.main(["leaderboard", str(tmp_path), "--by", "splx"]) == 1
    assert "did you mean 'spl'" in capsys.readouterr().err


def test_names_of_two_entries_of_one_team_differ(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "own"
    own.mkdir()
    for name in ("a.cbz", "b.cbz"):
        (own / name).write_bytes((folder / "two.cbz").read_bytes())
    entries, _ = load_entries(own, registry())
    assert [e.name for e in entries] == ["Two · goal_seek (a)", "Two · goal_seek (b)"]


def test_people_have_a_table_of_their_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of teleop, as a study or a person leaves them, stand on the page and rank with none."""
    person = replace(
        resolve_planner("dwa", registry()),
        spec_dump={"kind": "teleop"}, name="teleop", label="teleop", repeatable=False,
    )  # fmt: skip
    make_bundle(tmp_path, "dwa", "planner.cbz", team="Planner")
    monkeypatch.setattr("tests.core.bundle.made_up_runs.resolve_planner", lambda *_: person)
    make_bundle(tmp_path, "teleop", "people.cbz", team="People")
    entries, left_out = load_entries(tmp_path, registry())
    assert left_out == {}
    tables = {t.classed: t for t in standings(entries, "spl", ())}
    assert set(tables) == {"sensors only", "driven by a person"}
    assert [e.manifest.team for e in tables["driven by a person"].entries] == ["People"]
    board(tmp_path, tmp_path / "page.html")
    assert "driven by a person" in (tmp_path / "page.html").read_text(encoding="utf-8")
