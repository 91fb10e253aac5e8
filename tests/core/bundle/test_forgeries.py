"""Bundles that somebody thought about: each is refused, with what does not fit by name."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.core.bundle.archive import open_archive
from crowdbot.core.bundle.check import problems_of
from crowdbot.core.bundle.entries import load_entries
from crowdbot.core.bundle.manifest import MANIFEST
from crowdbot.core.recording.container.attachments import attach
from crowdbot.core.runs.run_record import record_problems
from crowdbot.core.scenarios.library import open_suite
from crowdbot.dsl.suite.expansion import Expansion
from crowdbot.errors import InputError
from tests.core.bundle.made_up_runs import make_bundle, registry, rewrite, write_recording

pytestmark = pytest.mark.slow

Change = Callable[[bytes], bytes | None]


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With recordings."""
    return make_bundle(tmp_path_factory.mktemp("forge"), recordings=True, team="Us")


def problems(bundle: Path) -> list[str]:
    with open_archive(bundle) as archive:
        return problems_of(archive, expansion(bundle.parent / "tiny.yaml"), registry())[1]


@cache
def expansion(suite: Path) -> Expansion:
    return open_suite(str(suite), registry())[0]


def members(bundle: Path, suffix: str) -> list[str]:
    with open_archive(bundle) as archive:
        return sorted(n for n in archive.names if n.endswith(suffix))


def in_json(**changes: Any) -> Change:
    return lambda content: json.dumps(json.loads(content) | changes).encode()


def in_edition(**changes: Any) -> Change:
    def change(content: bytes) -> bytes:
        document = json.loads(content)
        document["edition"] |= changes
        return json.dumps(document).encode()

    return change


def test_an_honest_bundle_with_recordings_fits(bundle: Path) -> None:
    assert problems(bundle) == []


# ---------------------------------------------------------------------- recordings
def test_a_recording_of_another_run_is_named(bundle: Path) -> None:
    names = members(bundle, "run.mcap")
    with open_archive(bundle) as archive:
        other = archive.read(names[3])
    found = problems(rewrite(bundle, {names[0]: lambda _: other}, honest=True))
    assert any("it is of scenario" in p for p in found)
    assert any("it is of another run" in p for p in found)
    assert any("has another hash than the run" in p for p in found)
    assert all(names[0] in p for p in found)


@pytest.mark.parametrize("header", [{}, {"run": "cb1-sha256:0"}])
def test_a_recording_of_nobody_is_named(
    bundle: Path, tmp_path: Path, header: dict[str, str]
) -> None:
    """The very numbers of the run, in a recording that is not the run's."""
    name = members(bundle, "run.mcap")[0]
    write_recording(tmp_path / "a.mcap", name.split("/")[2], header, 0.0)
    content = (tmp_path / "a.mcap").read_bytes()
    found = problems(rewrite(bundle, {name: lambda _: content}, honest=True))
    expected = "it is of another run" if header else "it does not say of which run it is"
    assert any(expected in p for p in found)
    assert not any("another hash" in p for p in found)


@pytest.mark.parametrize("content", [b"", b"junk", b"\x89MCAP0\r\n" + b"\0" * 200])
def test_junk_is_named(bundle: Path, content: bytes) -> None:
    name = members(bundle, "run.mcap")[2]
    found = problems(rewrite(bundle, {name: lambda _: content}, honest=True))
    assert len(found) == 1
    assert found[0].startswith(f"{name}: ")


def test_a_cut_recording_is_named(bundle: Path) -> None:
    name = members(bundle, "run.mcap")[0]
    found = problems(rewrite(bundle, {name: lambda c: c[:-40]}, honest=True))
    assert found == [f"{name}: it is cut: it can be read until 1 s"]


def test_some_recordings_are_not_all(bundle: Path) -> None:
    found = problems(rewrite(bundle, {members(bundle, "run.mcap")[0]: lambda _: None}, honest=True))
    assert len(found) == 1
    assert "recordings of some runs are there, not of all" in found[0]


def test_files_of_no_run_are_named(bundle: Path) -> None:
    more = {"runs/references/robot_alone-0/run.mcap": b"junk", "readme.json": b"{}"}
    found = problems(rewrite(bundle, {}, more, honest=True))
    assert "readme.json belongs to no run of the manifest" in found
    found = problems(rewrite(bundle, {}, dict([*more.items()][:1]), honest=True))
    assert found == [f"{next(iter(more))} belongs to no run of the manifest"]


def with_files(bundle: Path, tmp_path: Path, **changes: bytes) -> list[str]:
    """What is wrong when a recording has the files of its run inside, some of them changed."""
    name = members(bundle, "run.mcap")[0]
    with open_archive(bundle) as archive:
        archive.unpack(name, tmp_path / "run.mcap")
        record = json.loads(archive.text(name.replace("run.mcap", "run.json")))
        plain = {k: v for k, v in record.items() if k != "files"}
        inside = {
            "scenario.yaml": archive.read(name.replace("run.mcap", "scenario.yaml")),
            "scores.csv": archive.read(name.replace("run.mcap", "scores.csv")),
            "run.json": (json.dumps(plain, indent=2) + "\n").encode(),
        }
    attach(tmp_path / "run.mcap", inside | changes)
    content = (tmp_path / "run.mcap").read_bytes().replace(b"FLIPS", b"FLIPT")
    return problems(rewrite(bundle, {name: lambda _: content}, honest=True))


@pytest.mark.parametrize(("changes", "why"), [
    ({"scores.csv": b"better,scores"}, "scores.csv inside it is not that of the run"),
    ({"run.json": b"{}"}, "run.json inside it is not that of the run"),
    ({"scenario.yaml": b"FLIPS"}, "the checksum of 'scenario.yaml' is another one"),
    ({"more.txt": b"x"}, "a file inside it belongs to no run: more.txt"),
])  # fmt: skip
def test_files_inside_a_recording_are_those_of_its_run(
    bundle: Path, tmp_path: Path, changes: dict[str, bytes], why: str
) -> None:
    assert with_files(bundle, tmp_path) == []
    found = with_files(bundle, tmp_path, **changes)
    assert len(found) == 1
    assert why in found[0]


# ------------------------------------------------------------------------ manifest
@pytest.mark.parametrize(("change", "why"), [
    ({"title": "A tiny suit"}, "packed with title 'A tiny suit'"),
    ({"scenarios": 5}, "packed with scenarios 5; tiny here has 6"),
    ({"rules": 1}, "packed with rules 1"),
    ({"lock": "0" * 64}, "packed with lock '0000"),
])  # fmt: skip
def test_a_forged_edition_is_named(bundle: Path, change: dict[str, Any], why: str) -> None:
    found = problems(rewrite(bundle, {MANIFEST: in_edition(**change)}))
    assert any(why in p for p in found), found


@pytest.mark.parametrize(("change", "why"), [
    ({"seeds": [1]}, "its seeds are 1; the edition's are 0"),
    ({"seeds": []}, "its seeds are "),
    ({"missing": ["nothing seed-0"]}, "list of missing runs is wrong: nothing seed-0"),
    ({"pinned": False}, "the manifest says pinned: False"),
    ({"crowdbot": "9.9"}, "two versions of crowdbot"),
    ({"runs": []}, "there is no run in it"),
])  # fmt: skip
def test_a_forged_manifest_is_named(bundle: Path, change: dict[str, Any], why: str) -> None:
    found = problems(rewrite(bundle, {MANIFEST: in_json(**change)}))
    assert any(why in p for p in found), found


def test_runs_that_are_said_to_be_missing_and_are_not(bundle: Path) -> None:
    def hide(content: bytes) -> bytes:
        manifest = json.loads(content)
        gone = manifest["runs"].pop()
        manifest["missing"] = [f"{gone['scenario']} seed-0"] * 2
        return json.dumps(manifest).encode()

    found = problems(rewrite(bundle, {MANIFEST: hide}))
    assert any("list of missing runs is wrong: one run twice" in p for p in found)
    assert any("belongs to no run of the manifest" in p for p in found)


def test_two_runs_of_one_folder(bundle: Path) -> None:
    def share(content: bytes) -> bytes:
        manifest = json.loads(content)
        manifest["runs"][1]["directory"] = manifest["runs"][0]["directory"]
        return json.dumps(manifest).encode()

    found = problems(rewrite(bundle, {MANIFEST: share}))
    assert any("two runs have the same directory" in p for p in found)


def in_manifest(old: bytes, new: bytes) -> Change:
    return lambda content: content.replace(old, new, 1)


@pytest.mark.parametrize(("change", "why"), [
    (in_manifest(b'"team"', b'"team": "They", "team"'), "the key 'team' is there twice"),
    (in_json(team="\ud800"), "the hidden character U+D800"),
    (in_json(team="\u202eabc"), "the hidden character U+202E"),
    (in_json(team="a\nb"), "team: the character U+000A is not one that is shown"),
    (in_json(contact="x" * 201), "contact: String should have at most 200 characters"),
    (in_json(versions={"crowdbot": "\x1b[2J"}), "the hidden character U+001B"),
    (in_json(seeds=[float("nan")]), "NaN is not a number of JSON"),
    (in_edition(title="\u2028"), "the hidden character U+2028"),
])  # fmt: skip
def test_a_manifest_that_is_shown_otherwise_than_it_is(
    bundle: Path, change: Change, why: str
) -> None:
    forged = rewrite(bundle, {MANIFEST: change})
    with pytest.raises(InputError, match=re.escape(why)), open_archive(forged):
        pass


@pytest.mark.parametrize("team", ["\u202eUs", "a\nb", "\x1b[31m", "x" * 201])
def test_such_a_name_is_not_packed(tmp_path: Path, team: str) -> None:
    with pytest.raises(InputError, match="--team"):
        make_bundle(tmp_path, team=team)


def test_names_that_look_alike_are_told_apart(bundle: Path, tmp_path: Path) -> None:
    for number, team in enumerate(("Équipe", "E\u0301quipe", "équipe ", "Other")):
        forged = rewrite(bundle, {MANIFEST: in_json(team=team)})
        (tmp_path / f"{number}.cbz").write_bytes(forged.read_bytes())
    entries, _ = load_entries(tmp_path, registry())
    alike, other = entries[:3], entries[3]
    assert [e.name.endswith(f"({n})") for n, e in enumerate(alike)] == [True] * 3
    assert other.name == "Other · dwa"


@pytest.mark.parametrize(("change", "why"), [
    ({"seeds": [0, 1]}, "it lists 6 runs; the edition has 12"),
    ({"seeds": [7]}, "seed-0 is not a run of the manifest's seeds"),
])  # fmt: skip
def test_runs_that_a_manifest_does_not_account_for_keep_it_off_the_leaderboard(
    bundle: Path, tmp_path: Path, change: dict[str, Any], why: str
) -> None:
    """Nobody has to look at the suite for that."""
    forged = rewrite(bundle, {MANIFEST: in_json(**change)})
    (tmp_path / "a.cbz").write_bytes(forged.read_bytes())
    entries, left_out = load_entries(tmp_path, registry())
    assert entries == []
    assert why in left_out["a.cbz"]


@pytest.mark.parametrize(("change", "why"), [
    (in_manifest(b'"seed"', b'"seed": 1, "seed"'), "the key 'seed' is there twice"),
    (in_json(density=float("nan")), "NaN is not a number"),
    (in_json(reason="\ud800"), "the hidden character U+D800"),
    (in_manifest(b'"seed": 0', b'"seed": ' + b"9" * 5000), "has 5000 digits"),
])  # fmt: skip
def test_a_record_that_can_be_read_in_two_ways_is_named(
    bundle: Path, change: Change, why: str
) -> None:
    name = members(bundle, "run.json")[1]
    found = problems(rewrite(bundle, {name: change}, honest=True))
    assert any(p.startswith(f"{name} is not a JSON document: ") and why in p for p in found), found


# -------------------------------------------------------------------------- scores
def change_row(content: bytes, old: bytes, new: bytes) -> bytes:
    rows = content.split(b"\r\n")
    return b"\r\n".join(r.replace(old, new) if b",risk," in r else r for r in rows)


@pytest.mark.parametrize(("change", "why"), [
    (lambda c: c + c.split(b"\r\n")[1] + b"\r\n", "risk.corrected is there 2 times"),
    (lambda c: change_row(c, b",dwa,", b",other,"), "scores of another planner: 'other'"),
    (
        lambda c: change_row(c, b",ok,", b",ok,\xe2\x80\xae"),
        "reason has the hidden character U+202E",
    ),
    (lambda c: re.sub(rb",(lower|higher),ok", b",none,ok", c), ", none there, here "),
    (lambda c: re.sub(rb"(spl,.*,corrected),[^,]*,", rb"\1,2.5,", c), "is 2.5; it lies between 0 "),
    (lambda c: change_row(c, b",corrected,", b",better,"), "risk has no variant 'better'"),
    (lambda c: change_row(c, b",risk,", b",riskk,"), "which version of riskk was scored"),
    (lambda c: re.sub(rb",corrected,[^,]*,", b",corrected,nan,", c), "must not escape"),
])  # fmt: skip
def test_forged_scores_are_named(bundle: Path, change: Change, why: str) -> None:
    name = members(bundle, "scores.csv")[0]
    found = problems(rewrite(bundle, {name: change}, honest=True))
    assert any(why in p for p in found), found


# -------------------------------------------------------------------- wrong types
WRONG: tuple[dict[str, Any], ...] = (
    {"metrics": {"risk": 3, "spl": {"spec_version": 1}}},
    {"metrics": {"risk": {"spec_version": "1"}, "spl": {"spec_version": 1}}},
    {"metrics": {"risk": {"spec_version": True}, "spl": {"spec_version": 1}}},
    {"metrics": []},
    {"versions": {"crowdbot": 1}},
    {"planner": "dwa"},
    {"planner": {"kind": "dwa", "name": "dwa", "label": ["dwa"]}},
    {"plugins": {"a": 1}},
    {"plugins": [3]},
    {"references": ["x"]},
    {"references": {"robot_alone": 3}},
    {"seed": "0"},
    {"seed": -1},
    {"seed": 1e400},
    {"seed": 10**40},
    {"status": "perfect"},
    {"goal_time": "0.5"},
    {"goal_time": float("nan")},
    {"goal_time": -1.0},
    {"sim_time": float("inf")},
    {"privileged": 0},
    {"machine": None},
    {"conditions": {"rates.log": 8}},
    {"axes": 3},
    {"role": "winner"},
    {"planner_process": "inside"},
    {"run_id": None},
)


@pytest.mark.parametrize("change", WRONG, ids=[str(w)[:50] for w in WRONG])
def test_wrong_types_are_named(bundle: Path, change: dict[str, Any]) -> None:
    name = members(bundle, "run.json")[1]
    with open_archive(bundle) as archive:
        record = json.loads(archive.text(name))
    (key,) = change
    assert record_problems(record) == []
    assert any(p.startswith(f"'{key}") for p in record_problems(record | change))


@pytest.mark.parametrize("change", WRONG[::5], ids=[str(w)[:50] for w in WRONG[::5]])
def test_wrong_types_in_a_bundle_are_named(bundle: Path, change: dict[str, Any]) -> None:
    name = members(bundle, "run.json")[1]
    (key,) = change
    found = problems(rewrite(bundle, {name: in_json(**change)}, honest=True))
    assert any(f"run.json: '{key}" in p for p in found), found


def test_each_malformed_bundle_is_one_line_of_the_leaderboard(
    bundle: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "board"
    folder.mkdir()
    (folder / "good.cbz").write_bytes(bundle.read_bytes())
    record, table = members(bundle, "run.json")[1], members(bundle, "scores.csv")[1]
    changes: list[dict[str, Change]] = [{record: in_json(**w)} for w in WRONG[::6]]
    changes += [{table: lambda _: b"\xff"}, {record: lambda _: b"[" * 100_000}]
    for number, change in enumerate(changes):
        forged = rewrite(bundle, change, honest=True)
        (folder / f"bad-{number}.cbz").write_bytes(forged.read_bytes())
    entries, left_out = load_entries(folder, registry())
    assert [e.path.name for e in entries] == ["good.cbz"]
    assert len(left_out) == len(changes)
    assert all(left_out.values())
    page = tmp_path / "page.html"
    assert cli.main(["leaderboard", str(folder), "--out", str(page), "--by", "spl"]) == 0
    assert "Traceback" not in capsys.readouterr().err
    assert page.read_text().count("bad-") >= len(changes)


def test_something_that_nobody_thought_of_is_one_line(
    bundle: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.cbz").write_bytes(bundle.read_bytes())
    monkeypatch.setattr("crowdbot.core.bundle.entries.claimed_runs", lambda _: 1 / 0)
    _, left_out = load_entries(tmp_path, registry())
    assert left_out == {"a.cbz": "malformed: ZeroDivisionError: division by zero"}


# ------------------------------------------------- what other numbers of a page rest on
@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"axes": {"crowd": "mine"}}, "its axes are {'crowd': 'mine'}; the scenario's are {'flow'"),
        ({"axes": {}}, "its axes are {}; the scenario's are {'flow'"),
        ({"crowd": "x" * 64}, "its crowd is said to be 'xxx"),
        ({"goal_time": 99.0}, "its goal_time is 99 s, but it ended after 1 s"),
        ({"toppled_time": 2.0}, "its toppled_time is 2 s, but it ended after 1 s"),
        ({"sim_time": 0.25}, "its goal_time is 0.5 s, but it ended after 0.25 s"),
        ({"status": "timeout"}, "its status is 'timeout', but it has a time of arrival"),
    ],
)
def test_records_that_contradict_suite_or_themselves_are_named(
    bundle: Path, change: dict[str, Any], why: str
) -> None:
    names = members(bundle, "run.json")
    found = problems(rewrite(bundle, {n: in_json(**change) for n in names[:1]}, honest=True))
    assert any(why in p for p in found), found


def draw(number: int, **changes: Any) -> dict[str, Any]:
    return {"draw": number, "person": 3, "struck_time": 0.5, "toppled_time": 0.75,
            "realisation": f"cb1-sha256:{number}", "trajectory": f"cb1-sha256:t{number}",
            **changes}  # fmt: skip


@pytest.mark.parametrize(
    ("excused", "why"),
    [
        ([draw(0)], "1 of its draws were replaced, but at most 0 may be"),
        ([draw(1)], "not numbered from 0 on"),
        ([draw(0)], "does not have the people of the scenario"),
        ([draw(0), draw(1, realisation="cb1-sha256:0")], "have the same people"),
        ([draw(0, trajectory="own")], "is the run itself"),
        ([draw(0, struck_time=0.8)], "toppled before it was struck"),
    ],
)
def test_draws_that_were_never_replaced_are_named(
    bundle: Path, excused: list[dict[str, Any]], why: str
) -> None:
    def change(content: bytes) -> bytes:
        record = json.loads(content)
        own = record["hashes"]["trajectory"]
        draws = [e | {"trajectory": own} if e["trajectory"] == "own" else e for e in excused]
        return json.dumps(record | {"excused": draws}).encode()

    found = problems(rewrite(bundle, {members(bundle, "run.json")[0]: change}, honest=True))
    assert any(why in p for p in found), found


def test_a_crowd_of_another_version_is_told_in_its_own_way(bundle: Path) -> None:
    """Its text may be made otherwise there, so that only making the run again tells."""
    name = members(bundle, "run.json")[0]
    change = in_json(crowd="x" * 64, versions={"crowdbot": "0.0.1"})
    found = problems(rewrite(bundle, {name: change}, honest=True))
    assert not any("crowd is said" in p for p in found)
