"""Sealed planners: received before the draws are opened, run alone, with a log that is checked."""

from __future__ import annotations

import json
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.core.bundle.judge_log import LOG, LogLine, append, read_log
from crowdbot.core.bundle.signature import own_public_key
from crowdbot.core.bundle.submission import (
    About,
    read_submission,
    unpack_submission,
    write_submission,
)
from crowdbot.core.bundle.verification import content_hash
from crowdbot.core.campaign.judge import Judge, judge
from crowdbot.core.campaign.plan import Plan
from crowdbot.core.campaign.run import State
from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.containment.offer import kernel_offer
from crowdbot.core.registry.registry import discover
from crowdbot.core.runs.run_options import RunOptions
from crowdbot.errors import InputError, Interrupted
from tests.core.planning.process.process_cases import older_kernel
from tests.paths import DATA

PLANNER = """\
from pathlib import Path
import helper_of_steady
class Steady:
    needs = ()
    data = ("speed.txt",)
    def reset(self, task, limits, sensors, seed):
        self.speed = float(Path(__file__).with_name("speed.txt").read_text())
    def step(self, obs):
        return (self.speed, helper_of_steady.TURN)
"""
SUITE = """\
crowdbot: 1
suite: {id: judged, seed: 3}
base:
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/turtlebot2.yaml"]
  robots.robot.task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}, time_limit: 1 s}
metrics: [success, safe_efficiency]
"""

HIDDEN = """\
crowdbot: 1
suite: {id: hidden}
base: {extends: minimal.yaml}
matrix: {pace: {slow: {crowd.speed.mean: 1}, fast: {crowd.speed.mean: 2}}}
"""


def _planner(folder: Path, speed: float = 0.3) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "steady.py").write_text(PLANNER)
    (folder / "helper_of_steady.py").write_text("TURN = 0.1\n")
    (folder / "speed.txt").write_text(f"{speed}\n")
    return folder / "steady.py"


def _seal(folder: Path, out: Path, *more: str) -> int:
    words = ["seal", f"{folder / 'steady.py'}:Steady", "--out", str(out), *more]
    return cli.main([*words, "--include", "speed.txt"])


def _log(folder: Path) -> list[str]:
    return [line.event for line in read_log(folder / LOG, {own_public_key()})]


def _judge(folder: Path) -> int:
    return cli.main(["judge", str(folder / "suite.yaml"), str(folder / "in"), "--out",
                     str(folder / "out"), "--jobs", "1"])  # fmt: skip


def test_parameters_without_code_are_sealed(tmp_path: Path) -> None:
    digests = set()
    for speed in (0.5, 0.6):
        (tmp_path / "slow.yaml").write_text(f"kind: dwa\nspeed: {speed}\n")
        out = tmp_path / f"{speed}.cbs"
        assert cli.main(["seal", str(tmp_path / "slow.yaml"), "--out", str(out)]) == 0
        sealed = read_submission(out)
        assert set(sealed.about.files) == {"slow.yaml"}
        digests.add(sealed.about.digest)
    assert len(digests) == 2


def test_a_submission_is_what_was_sealed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _planner(tmp_path / "mine")
    assert _seal(tmp_path / "mine", tmp_path / "a.cbs", "--team", "Us") == 0
    shown = capsys.readouterr().out
    sealed = read_submission(tmp_path / "a.cbs")
    assert sealed.sha256 in shown
    assert set(sealed.about.files) == {"steady.py", "helper_of_steady.py", "speed.txt"}
    assert _seal(tmp_path / "mine", tmp_path / "b.cbs", "--team", "Us") == 0
    assert (tmp_path / "a.cbs").read_bytes() == (tmp_path / "b.cbs").read_bytes()
    (tmp_path / "copy").mkdir()
    place = unpack_submission(sealed, tmp_path / "copy")
    assert place.read_text() == PLANNER


def test_data_that_is_missing_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _planner(tmp_path / "mine")
    words = ["seal", f"{tmp_path / 'mine/steady.py'}:Steady", "--out", str(tmp_path / "a.cbs")]
    assert cli.main(words) == 1
    assert "see --include" in capsys.readouterr().err
    assert not (tmp_path / "a.cbs").exists()


@pytest.mark.parametrize("name", ["../up.py", "/abs.py", ".hidden", "a/../b.py", "a\\b.py", "x y"])
def test_names_that_lead_out_are_refused(name: str, tmp_path: Path) -> None:
    file = tmp_path / "f.py"
    file.write_text("")
    about = About(planner="f.py:F", digest="a" * 64, files={})
    with pytest.raises(InputError):
        write_submission(tmp_path / "a.cbs", about, {"f.py": file, name: file})
    with zipfile.ZipFile(tmp_path / "b.cbs", "w") as archive:
        archive.writestr("submission.json", "{}")
        archive.writestr(name, "")
    with pytest.raises(InputError, match="is not allowed"):
        read_submission(tmp_path / "b.cbs")


def test_a_changed_submission_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "f.py"
    file.write_text("good = 1\n")
    about = About(planner="f.py:F", digest="a" * 64, files={})
    write_submission(tmp_path / "a.cbs", about, {"f.py": file})
    with (
        zipfile.ZipFile(tmp_path / "a.cbs") as old,
        zipfile.ZipFile(tmp_path / "b.cbs", "w") as new,
    ):
        new.writestr("submission.json", old.read("submission.json"))
        new.writestr("f.py", "evil = 1\n")
    (tmp_path / "folder").mkdir()
    with pytest.raises(InputError, match="it was changed"):
        unpack_submission(read_submission(tmp_path / "b.cbs"), tmp_path / "folder")


def test_a_log_is_append_only(tmp_path: Path) -> None:
    path, lines = tmp_path / LOG, list[LogLine]()
    for number in range(3):
        append(path, lines, "received", submission=str(number))
    own = {own_public_key()}
    assert [x.sha256 for x in read_log(path, own)] == [x.sha256 for x in lines]
    text = path.read_text().splitlines(keepends=True)
    for changed, why in (
        ([text[0], text[2]], ":2: a line before it was changed"),
        ([text[1], text[0], text[2]], ":1: a line before it"),
        ([text[0], text[1].replace('"1"', '"9"'), text[2]], ":2: it was changed"),
        ([*text[:2], text[2].rstrip()], "cut off"),
        (["{}\n"], ":1: not a line"),
    ):
        path.write_text("".join(changed))
        with pytest.raises(InputError, match=why):
            read_log(path, own)
    path.write_text("".join(text))
    with pytest.raises(InputError, match="not trusted"):
        read_log(path, {"ab" * 32})


@pytest.mark.slow
def test_judged_from_hand_in_to_the_leaderboard(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "suite.yaml").write_text(SUITE)
    (tmp_path / "in").mkdir()
    for team, speed in (("One", 0.3), ("Two", 0.5)):
        _planner(tmp_path / team, speed)
        assert _seal(tmp_path / team, tmp_path / "in" / f"{team}.cbs", "--team", team) == 0
    assert _judge(tmp_path) == 0
    assert _log(tmp_path / "out") == ["received", "received", "opened", "judged", "judged"]
    assert not list((tmp_path / "out" / "planners").iterdir())
    bundles = sorted((tmp_path / "out").glob("*.cbz"))
    assert len(bundles) == 2
    saved: dict[str, Any] = json.loads(bundles[0].with_suffix(".verified.json").read_text())
    assert (saved["outcome"], saved["ok"]) == ("judged", True)

    assert _judge(tmp_path) == 0  # nothing is left to do
    assert len(_log(tmp_path / "out")) == 5
    _planner(tmp_path / "Late", 0.9)
    assert _seal(tmp_path / "Late", tmp_path / "in" / "Late.cbs") == 0
    capsys.readouterr()
    assert _judge(tmp_path) == 1
    assert "after the draws were opened" in capsys.readouterr().err

    page = tmp_path / "page.html"
    assert cli.main(["leaderboard", str(tmp_path / "out"), "--out", str(page)]) == 0
    assert "judged: the organisers made all 1 runs" in page.read_text()
    capsys.readouterr()
    assert cli.main(["judge-log", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    assert saved["submission"] in shown  # whole, to compare with one's own
    assert f"signed with the public key {own_public_key()}" in shown
    sealed = {content_hash(file): file for file in (tmp_path / "in").glob("*.cbs")}
    words = ["verify", str(bundles[0]), "--suite", str(tmp_path / "suite.yaml"), "--source"]
    assert cli.main([*words, str(sealed.pop(saved["submission"]))]) == 0
    assert "the same" in capsys.readouterr().out
    assert cli.main([*words, str(sealed.popitem()[1])]) == 1  # another team's
    assert "cannot be re-run" in capsys.readouterr().out
    (tmp_path / "suite.yaml").write_text(SUITE.replace("id: judged", "id: other"))
    assert _judge(tmp_path) == 1
    assert "log of another suite" in capsys.readouterr().err


def test_hidden_draws_only_receive(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copy(DATA / "diagnostics" / "parts" / "minimal.yaml", tmp_path)
    (tmp_path / "suite.yaml").write_text(HIDDEN)
    draws = [str(tmp_path / "suite.yaml"), "--secret", str(tmp_path / "secret.json")]
    assert cli.main(["draws", "commit", *draws]) == 0
    _planner(tmp_path / "mine")
    (tmp_path / "in").mkdir()
    assert _seal(tmp_path / "mine", tmp_path / "in" / "us.cbs") == 0
    capsys.readouterr()
    for received in ("1 new submission", "0 new submissions"):
        assert _judge(tmp_path) == 0
        output = capsys.readouterr().out
        assert f"{received} received; the draws are hidden: nothing was run" in output
    assert _log(tmp_path / "out") == ["received"]
    assert cli.main(["draws", "reveal", *draws]) == 0
    shutil.rmtree(tmp_path / "out")  # as if it had come after the reveal
    assert _judge(tmp_path) == 1
    assert "us.cbs is left out: not received before the draws were" in capsys.readouterr().err
    assert "received" not in _log(tmp_path / "out")


@pytest.mark.parametrize(
    ("dates", "why"),
    [("opens: 2999-01-01", "the round opens on 2999-01-01"),
     ("closes: 2001-01-01", "the round closed on 2001-01-01")],
)  # fmt: skip
def test_nothing_is_received_outside_the_round(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], dates: str, why: str
) -> None:
    (tmp_path / "suite.yaml").write_text(SUITE + f"round: {{{dates}}}\n")
    (tmp_path / "in").mkdir()
    _planner(tmp_path / "mine")
    assert _seal(tmp_path / "mine", tmp_path / "in" / "a.cbs") == 0
    assert _judge(tmp_path) == 1
    assert f"a.cbs is left out: {why}" in capsys.readouterr().err
    assert "received" not in _log(tmp_path / "out")


def _setup(folder: Path, run: Callable[[Plan], State]) -> Judge:
    """Return a judge of one submission whose runs are made by a function."""
    (folder / "suite.yaml").write_text(SUITE)
    (folder / "in").mkdir()
    _planner(folder / "mine")
    assert _seal(folder / "mine", folder / "in" / "us.cbs") == 0
    options = RunOptions(place=PlannerPlace(lenient=True, contained=True), replay=False)
    return Judge(
        suite=str(folder / "suite.yaml"), submissions=folder / "in", out=folder / "out",
        registry=discover(allow=()), run=run, options=options,
    )  # fmt: skip


@pytest.mark.skipif(kernel_offer().missing != "", reason="this kernel contains nothing")
def test_what_is_not_the_submissions_fault_is_not_its_end(tmp_path: Path) -> None:
    errors = iter([InputError("no scheduler answers"), Interrupted()])

    def run(_: Plan) -> State:
        raise next(errors)

    setup = _setup(tmp_path, run)
    assert judge(setup).left_out["us.cbs"] == "no scheduler answers; the same command goes on"
    with pytest.raises(Interrupted):
        judge(setup)
    assert _log(tmp_path / "out") == ["received", "opened", "incomplete"]
    assert not list((tmp_path / "out" / "planners").iterdir())


FAILING = """\
import os
class Failing:
    needs = ()
    def reset(self, task, limits, sensors, seed):
        pass
    def step(self, obs):
        os._exit(3)
"""


@pytest.mark.slow
def test_a_planner_that_always_fails_does_not_keep_the_next_from_being_judged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "suite.yaml").write_text(SUITE)
    for name in ("in", "first"):
        (tmp_path / name).mkdir()
    (tmp_path / "first" / "failing.py").write_text(FAILING)
    words = ["seal", f"{tmp_path / 'first' / 'failing.py'}:Failing"]
    assert cli.main([*words, "--out", str(tmp_path / "in" / "a.cbs")]) == 0
    _planner(tmp_path / "second")
    assert _seal(tmp_path / "second", tmp_path / "in" / "b.cbs") == 0
    assert _judge(tmp_path) == 0
    assert _log(tmp_path / "out") == ["received", "received", "opened", "judged", "judged"]
    lines = read_log(tmp_path / "out" / LOG, {own_public_key()})
    endings = [line.document["statuses"] for line in lines if line.event == "judged"]
    assert endings == [{"planner_failed": 1}, {"timeout": 1}]
    page = tmp_path / "page.html"
    assert cli.main(["leaderboard", str(tmp_path / "out"), "--out", str(page)]) == 0
    assert page.read_text().index("Steady") < page.read_text().index("Failing")
    capsys.readouterr()


def test_nothing_is_run_where_it_would_not_be_contained(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    setup = _setup(tmp_path, lambda plan: pytest.fail(str(plan)))
    with older_kernel(monkeypatch, 0), pytest.raises(InputError, match="would not be contained"):
        judge(setup)
    assert _log(tmp_path / "out") == ["received"]


@pytest.mark.parametrize("names", [("a", "a/b"), ("a/b", "a/b/c"), ("x" * 201,)])
def test_names_that_no_folder_can_have_are_refused(names: list[str], tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "b.cbs", "w") as archive:
        for name in ("submission.json", *names):
            archive.writestr(name, "{}")
    with pytest.raises(InputError, match=r"name of a folder|is not allowed"):
        read_submission(tmp_path / "b.cbs")
